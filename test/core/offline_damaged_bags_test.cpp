#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "offline_bags.h"

namespace virtual_work_dynamics {
namespace {

class OfflineDamagedBags : public OfflineBags {};

// A bag that ends anywhere gives the messages before that, or none in one line.
TEST_F(OfflineDamagedBags, CutOffGiveWhatTheyHaveAndSaySo) {
  for (const char* name : {"none.bag", "bz2.bag", "lz4.bag"}) {
    const std::string whole = readFile(bag(name));
    int least = kMessages, most = 0;
    for (std::size_t size = 4200; size < whole.size(); size += 397) {
      SCOPED_TRACE(std::string(name) + " of " + std::to_string(size) + " bytes");
      copy("cut.bag", whole.substr(0, size));
      const Run result = positions("cut.bag");
      if (result.exit_code != 0) {
        EXPECT_EQ(countLines(result.err, "cut.bag is damaged: byte "), 1) << result.err;
        EXPECT_EQ(result.out, "");
        least = 0;
        continue;
      }
      EXPECT_EQ(countLines(result.err, "warning: cut.bag: is damaged, what can be read is: byte "),
                1)
          << result.err;
      const int rows = static_cast<int>(linesOf(result.out).size()) - 1;
      std::vector<int> first = allMessages();
      first.resize(static_cast<std::size_t>(rows));
      expectRows(result.out, first);
      EXPECT_GE(rows, most);  // of more bytes, no fewer
      most = rows;
    }
    EXPECT_EQ(least, 0);
    EXPECT_EQ(most, kMessages);
  }
}

TEST_F(OfflineDamagedBags, LeaveOutAChunkThatIsBroken) {
  for (const char* name : {"bz2.bag", "lz4.bag"}) {
    SCOPED_TRACE(name);
    std::string content = readFile(bag(name));
    // The third chunk: behind its op, compression and size come the compressed bytes.
    std::size_t chunk = 0;
    for (int i = 0; i < 3; ++i) chunk = content.find("compression=", chunk + 1);
    content[chunk + 100] = static_cast<char>(content[chunk + 100] ^ 0x55);
    copy("broken.bag", content);
    const Run result = positions("broken.bag");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "a chunk cannot be decompressed and is left out"), 1)
        << result.err;
    const std::vector<std::string> lines = linesOf(result.out);
    std::vector<std::string> whole = linesOf(positions(bag(name)).out);
    EXPECT_LT(lines.size(), whole.size());
    EXPECT_GE(lines.size(), whole.size() - 10);  // messages of a chunk
    for (const std::string& line : lines) {
      EXPECT_NE(std::find(whole.begin(), whole.end(), line), whole.end()) << line;
    }
  }
}

std::uint32_t wordAt(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

// Where the lengths of data of the records between two places stand.
std::vector<std::size_t> dataLengths(const std::string& bytes, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> places;
  for (std::size_t at = begin; at < end;) {
    const std::size_t length = at + 4 + wordAt(bytes, at);
    places.push_back(length);
    at = length + 4 + wordAt(bytes, length);
  }
  return places;
}

TEST_F(OfflineDamagedBags, LeaveOutTheRestOfAChunkWhoseRecordGoesBeyondItsEnd) {
  const std::string whole = readFile(bag("none.bag"));
  const std::size_t magic = std::string("#ROSBAG V2.0\n").size();
  // Within the second chunk, all of whose bytes are there, its second message seems to be longer.
  std::vector<std::size_t> chunks;
  std::size_t header = magic;
  for (const std::size_t length : dataLengths(whole, magic, whole.size())) {
    if (whole.substr(header, length - header).find("compression=") != std::string::npos) {
      chunks.push_back(length);
    }
    header = length + 4 + wordAt(whole, length);
  }
  ASSERT_GT(chunks.size(), 3U);
  const std::size_t begin = chunks[1] + 4, end = begin + wordAt(whole, chunks[1]);
  const std::vector<std::size_t> records = dataLengths(whole, begin, end);
  ASSERT_GT(records.size(), 3U);
  const auto inFirst = dataLengths(whole, chunks[0] + 4, chunks[0] + 4 + wordAt(whole, chunks[0]));
  const auto before = inFirst.size() - 1;  // messages; the first record is the connection
  for (const std::uint32_t more : {1000U, 100000U, 4000000000U}) {
    std::string changed = whole;
    const std::uint32_t length = wordAt(whole, records[1]) + more;
    std::memcpy(&changed[records[1]], &length, sizeof length);
    copy("beyond.bag", changed);
    const Run result = positions("beyond.bag");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(countLines(result.err, "is damaged, what can be read is: byte "), 1) << result.err;
    EXPECT_EQ(countLines(result.err, "a chunk ends in a record"), 1) << result.err;
    std::vector<int> messages = allMessages();
    const auto from = messages.begin() + static_cast<std::ptrdiff_t>(before) + 1;
    messages.erase(from, from + static_cast<std::ptrdiff_t>(records.size()) - 1);
    expectRows(result.out, messages);
  }
}

// Bytes changed at random may cost messages, but never end the tool in another way, and every row
// is one of the whole bag where the bytes are not those of numbers.
TEST_F(OfflineDamagedBags, ChangedAtRandomNeverEndTheToolOtherwise) {
  for (const char* name : {"none.bag", "bz2.bag", "lz4.bag"}) {
    const std::string whole = readFile(bag(name));
    std::uint32_t random = 12345;
    for (int i = 0; i < 20; ++i) {
      std::string changed = whole;
      for (int k = 0; k < 3; ++k) {
        random = random * 1664525 + 1013904223;
        const std::size_t place = 13 + random % (whole.size() - 13);
        random = random * 1664525 + 1013904223;
        changed[place] = static_cast<char>(random >> 24);
      }
      copy("changed.bag", changed);
      const Run result = positions("changed.bag");
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << i << ": " << result.err;
    }
  }
}

}  // namespace
}  // namespace virtual_work_dynamics
