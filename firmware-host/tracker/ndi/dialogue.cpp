// Reads recorded dialogues.
#include "firmware-host/tracker/ndi/dialogue.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>

#include "firmware-host/tracker/ndi/hex.hpp"

namespace orcart::ndi {
namespace {

constexpr std::size_t kMaxMessageBytes = 65536;

struct Heading {
  Speaker speaker = Speaker::host;
  int number = 0;
  std::size_t length = 0;
  std::size_t end = 0;  ///< where the message begins
};

std::optional<int> read_int(std::string_view digits) {
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc{} && end == digits.data() + digits.size() && value >= 0 ? std::optional{value}
                                                                                    : std::nullopt;
}

/// The next `N. command[len] ` or `N. receive[len] ` at or behind `from`.
std::optional<Heading> next_heading(std::string_view text, std::size_t from) {
  constexpr std::string_view kCommand = ". command[";
  constexpr std::string_view kReceive = ". receive[";
  for (std::size_t dot = text.find(". ", from); dot != std::string_view::npos;
       dot = text.find(". ", dot + 1)) {
    const std::string_view rest = text.substr(dot);
    if (!rest.starts_with(kCommand) && !rest.starts_with(kReceive)) continue;
    const std::size_t open = dot + kCommand.size();
    const std::size_t close = text.find("] ", open);
    std::size_t first = dot;
    while (first > from && text[first - 1] >= '0' && text[first - 1] <= '9') --first;
    const auto number = read_int(text.substr(first, dot - first));
    const auto length =
        close == std::string_view::npos ? std::nullopt : read_int(text.substr(open, close - open));
    if (!number || !length || static_cast<std::size_t>(*length) > kMaxMessageBytes) continue;
    const Speaker speaker = rest.starts_with(kCommand) ? Speaker::host : Speaker::device;
    return Heading{speaker, *number, static_cast<std::size_t>(*length), close + 2};
  }
  return std::nullopt;
}

std::string without_escapes(std::string_view line) {
  std::string bytes;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto code = line.substr(i).starts_with("\\x") && i + 4 <= line.size()
                          ? parse_hex(line.substr(i + 2, 2))
                          : std::nullopt;
    if (code) {
      bytes += static_cast<char>(*code);
      i += 3;
    } else if (line.substr(i).starts_with("\\\\")) {
      bytes += '\\';
      ++i;
    } else {
      bytes += line[i];
    }
  }
  return bytes;
}

Dialogue parse_log(std::string_view text) {
  Dialogue records;
  for (auto heading = next_heading(text, 0); heading; heading = next_heading(text, heading->end)) {
    std::string_view line = text.substr(heading->end);
    line = line.substr(0, line.find('\n'));
    if (line.ends_with('\r')) line.remove_suffix(1);
    records.push_back({heading->speaker, heading->number, without_escapes(line)});
  }
  return records;
}

/// Text messages end in their CRC and, in this notation, a line feed for the carriage return.
void restore_carriage_return(std::string& bytes) {
  const bool is_text = bytes.size() >= 5 && bytes.back() == '\n' &&
                       parse_hex(std::string_view(bytes).substr(bytes.size() - 5, 4)).has_value();
  if (is_text) bytes.back() = '\r';
}

Dialogue parse_raw(std::string_view text) {
  Dialogue records;
  for (auto heading = next_heading(text, 0); heading;) {
    const std::size_t end = std::min(text.size(), heading->end + heading->length);
    std::string bytes(text.substr(heading->end, end - heading->end));
    restore_carriage_return(bytes);
    records.push_back({heading->speaker, heading->number, std::move(bytes)});
    heading = next_heading(text, end);
  }
  return records;
}

Dialogue parse_sent_and_received(std::string_view text) {
  Dialogue records;
  bool open = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool sent = line.starts_with("sent:");
    const std::size_t equals = line.find(" = ");
    if ((sent || line.starts_with("recv:")) && equals != std::string_view::npos) {
      const int number = read_int(line.substr(5, equals - 5)).value_or(0);
      records.push_back(
          {sent ? Speaker::host : Speaker::device, number, std::string(line.substr(equals + 3))});
      open = true;
    } else if (open && !line.empty()) {
      records.back().bytes += '\n';
      records.back().bytes += line;
    }
  }
  for (DialogueRecord& record : records) {
    if (!record.bytes.empty()) record.bytes += '\r';
  }
  return records;
}

bool begins_binary(std::string_view bytes) {
  return bytes.starts_with("\xC4\xA5");
}

/// A binary reply may have been recorded as header and body.
Dialogue with_replies_whole(Dialogue records) {
  Dialogue whole;
  for (DialogueRecord& record : records) {
    if (record.bytes.empty()) continue;
    const bool goes_on = !whole.empty() && whole.back().speaker == Speaker::device &&
                         record.speaker == Speaker::device && whole.back().number == record.number &&
                         begins_binary(whole.back().bytes) && !begins_binary(record.bytes);
    if (goes_on) {
      whole.back().bytes += record.bytes;
    } else {
      whole.push_back(std::move(record));
    }
  }
  return whole;
}

}  // namespace

Result<Dialogue> parse_dialogue(std::string_view content, std::string_view name) {
  Dialogue records;
  if (content.find("sent:") != std::string_view::npos && content.find("recv:") != std::string_view::npos) {
    records = parse_sent_and_received(content);
  } else if (content.find("\\x0D") != std::string_view::npos) {
    records = parse_log(content);
  } else {
    records = parse_raw(content);
  }
  records = with_replies_whole(std::move(records));
  if (records.empty()) {
    return fail(
        "dialogue " + std::string(name) +
        " holds no NDI messages; records such as \"1. command[10] INIT:E3A5\" or \"sent:0001 = INIT:E3A5\" "
        "would be accepted");
  }
  return records;
}

Result<Dialogue> read_dialogue(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail("dialogue " + file.string() + " cannot be opened; a readable file is wanted");
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return parse_dialogue(content, file.string());
}

}  // namespace orcart::ndi
