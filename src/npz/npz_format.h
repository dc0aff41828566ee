#pragma once

#include <cstdint>

namespace virtual_work_dynamics {

// The records of a zip file, https://pkware.cachefly.net/webdocs/casestudies/APPNOTE.TXT, of which
// an .npz is one: a .npy for each array, https://numpy.org/doc/stable/reference/generated/
// numpy.lib.format.html.
namespace npz {

constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kCentralHeader = 0x02014b50;
constexpr std::uint32_t kEnd = 0x06054b50;
constexpr std::uint32_t kEnd64 = 0x06064b50;
constexpr std::uint32_t kEnd64Locator = 0x07064b50;
constexpr std::uint16_t kExtra64 = 1;  ///< of an entry: its lengths and place in 64 bits

constexpr std::uint32_t kIn64 = 0xffffffff;   ///< the number stands in 64 bits elsewhere
constexpr std::uint16_t kCountIn64 = 0xffff;  ///< the number of entries does
constexpr std::uint16_t kVersion = 20, kVersion64 = 45;
constexpr std::uint16_t kUtf8Names = 0x0800;  ///< flag
constexpr std::uint16_t kEncrypted = 0x0001;  ///< flag
constexpr std::uint16_t kStored = 0;          ///< method: not compressed
constexpr std::uint16_t kFirstDay = 0x21;     ///< 1980-01-01: equal results make equal files

constexpr std::size_t kLocalLength = 30, kCentralLength = 46, kEndLength = 22;
constexpr std::size_t kEnd64Length = 56, kLocatorLength = 20;

constexpr char kArray[] = ".npy";       ///< ends the name of an array's file
constexpr char kMagic[] = "\x93NUMPY";  ///< begins it

}  // namespace npz
}  // namespace virtual_work_dynamics
