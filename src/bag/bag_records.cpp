#include "bag/bag_records.h"

namespace virtual_work_dynamics {

std::optional<std::string_view> BagHeader::find(std::string_view name) const {
  ByteCursor cursor(bytes_);
  while (!cursor.empty()) {
    const std::string_view field = cursor.sized();
    const std::size_t equals = field.find('=');
    if (!cursor.ok() || equals == std::string_view::npos) return std::nullopt;
    if (field.substr(0, equals) == name) return field.substr(equals + 1);
  }
  return std::nullopt;
}

std::optional<std::uint32_t> BagHeader::word(std::string_view name) const {
  const auto value = find(name);
  if (!value || value->size() != 4) return std::nullopt;
  return ByteCursor(*value).word();
}

std::optional<std::uint64_t> BagHeader::longWord(std::string_view name) const {
  const auto value = find(name);
  if (!value || value->size() != 8) return std::nullopt;
  return ByteCursor(*value).longWord();
}

std::optional<std::int64_t> BagHeader::time(std::string_view name) const {
  const auto value = find(name);
  if (!value || value->size() != 8) return std::nullopt;
  ByteCursor cursor(*value);
  const std::uint64_t seconds = cursor.word(), nanoseconds = cursor.word();
  constexpr std::uint64_t kSecond = 1000000000;
  if (nanoseconds >= kSecond) return std::nullopt;
  return static_cast<std::int64_t>(seconds * kSecond + nanoseconds);
}

std::optional<BagOp> BagHeader::op() const {
  const auto value = find("op");
  if (!value || value->size() != 1) return std::nullopt;
  return static_cast<BagOp>(ByteCursor(*value).byte());
}

std::optional<BagConnection> readConnection(const BagHeader& header, std::string_view data) {
  const BagHeader described(data);
  const auto topic = header.find("topic");
  const auto type = described.find("type");
  const auto md5sum = described.find("md5sum");
  const auto definition = described.find("message_definition");
  if (!topic || !type || !md5sum || !definition) return std::nullopt;
  BagConnection connection;
  connection.topic = *topic;
  connection.type = *type;
  connection.md5sum = *md5sum;
  connection.definition = *definition;
  connection.caller_id = described.find("callerid").value_or("");
  connection.latching = described.find("latching").value_or("0") == "1";
  return connection;
}

}  // namespace virtual_work_dynamics
