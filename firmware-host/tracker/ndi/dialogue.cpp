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

constexpr std::size_t kMaxMessageBytes = 1u << 20;

struct Heading {
  Speaker speaker = Speaker::host;
  int number = 0;
  std::size_t begin = 0;  ///< where its number, or its word, stands
  std::size_t length = 0;
  std::size_t end = 0;  ///< where the message begins
};

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

std::optional<int> read_int(std::string_view digits) {
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc{} && end == digits.data() + digits.size() && value >= 0 ? std::optional{value}
                                                                                    : std::nullopt;
}

/// Where the number in front of `at` begins (`12. `), and what it is; 0 where there is none.
int number_before(std::string_view text, std::size_t from, std::size_t& at) {
  if (at < from + 3 || text[at - 1] != ' ' || text[at - 2] != '.' || !is_digit(text[at - 3])) return 0;
  std::size_t first = at - 2;
  while (first > from && is_digit(text[first - 1])) --first;
  const int number = read_int(text.substr(first, at - 2 - first)).value_or(0);
  at = first;
  return number;
}

/// The next `N. command[len] ` or `N. receive[len] ` at or behind `from`; the number may be missing.
std::optional<Heading> next_heading(std::string_view text, std::size_t from) {
  constexpr std::string_view kCommand = "command[";
  constexpr std::string_view kReceive = "receive[";
  for (std::size_t open = text.find('[', from); open != std::string_view::npos;
       open = text.find('[', open + 1)) {
    if (open < from + kCommand.size() - 1) continue;
    const std::size_t word = open + 1 - kCommand.size();
    const bool sent = text.substr(word).starts_with(kCommand);
    if (!sent && !text.substr(word).starts_with(kReceive)) continue;
    const std::size_t close = text.find(']', open);
    if (close == std::string_view::npos || close - open > 8) continue;
    const auto length = read_int(text.substr(open + 1, close - open - 1));
    if (!length || static_cast<std::size_t>(*length) > kMaxMessageBytes) continue;
    Heading heading{.speaker = sent ? Speaker::host : Speaker::device,
                    .begin = word,
                    .length = static_cast<std::size_t>(*length),
                    .end = close + 1};
    if (heading.end < text.size() && text[heading.end] == ' ') ++heading.end;
    heading.number = number_before(text, from, heading.begin);
    return heading;
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

std::string_view without_line_end(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

Dialogue parse_log(std::string_view text) {
  Dialogue records;
  for (auto heading = next_heading(text, 0); heading; heading = next_heading(text, heading->end)) {
    std::string_view line = text.substr(heading->end);
    const bool last = line.find('\n') == std::string_view::npos;
    line = without_line_end(line.substr(0, line.find('\n')));
    DialogueRecord record{heading->speaker, heading->number, without_escapes(line)};
    record.cut_off = last && record.bytes.size() < heading->length;
    heading->end += line.size();
    records.push_back(std::move(record));
  }
  return records;
}

/// Text messages end in their CRC and, in this notation, a line feed for the carriage return.
void restore_carriage_return(std::string& bytes) {
  const bool is_text = bytes.size() >= 5 && bytes.back() == '\n' &&
                       parse_hex(std::string_view(bytes).substr(bytes.size() - 5, 4)).has_value();
  if (is_text) bytes.back() = '\r';
}

/// Where a message of the stated length ends. Where no record follows there but one begins inside, the length
/// is not to be believed (line ends were changed on the way): then the message is what stands in front of
/// that record.
std::size_t end_of_message(std::string_view text, const Heading& heading) {
  const std::size_t end = std::min(text.size(), heading.end + heading.length);
  const auto next = next_heading(text, heading.end);
  if (!next || next->begin >= end) return end;
  const auto behind = next_heading(text, end);
  const bool follows = behind && text.find_first_not_of("\r\n ", end) == behind->begin;
  return follows ? end : next->begin;
}

/// The message up to the next record, where it does not end after its stated length, but would were each CR
/// LF a line feed: what a text mode has made of a binary recording.
std::optional<std::string> with_line_feeds_back(std::string_view text, const Heading& heading) {
  const auto next = next_heading(text, heading.end);
  const std::size_t behind =
      text.find_first_not_of("\r\n ", std::min(text.size(), heading.end + heading.length));
  if (behind == std::string_view::npos || (next && behind == next->begin)) return std::nullopt;
  std::string message(text.substr(heading.end, next ? next->begin - heading.end : std::string::npos));
  for (std::size_t at = message.find("\r\n"); at != std::string::npos; at = message.find("\r\n", at + 1))
    message.erase(at, 1);
  return message.size() == heading.length ? std::optional{std::move(message)} : std::nullopt;
}

Dialogue parse_raw(std::string_view text) {
  Dialogue records;
  for (auto heading = next_heading(text, 0); heading;) {
    const std::size_t end = end_of_message(text, *heading);
    DialogueRecord record{heading->speaker, heading->number,
                          std::string(text.substr(heading->end, end - heading->end))};
    record.cut_off = end == text.size() && record.bytes.size() < heading->length;
    if (auto message = with_line_feeds_back(text, *heading)) record.bytes = std::move(*message);
    restore_carriage_return(record.bytes);
    records.push_back(std::move(record));
    heading = next_heading(text, end);
  }
  return records;
}

/// `sent:N = ` or `recv:N = ` on a line, behind whatever a program put in front.
std::optional<Heading> turn_on(std::string_view line) {
  for (const bool sent : {true, false}) {
    const std::size_t word = line.find(sent ? "sent:" : "recv:");
    if (word == std::string_view::npos) continue;
    const std::size_t equals = line.find(" =", word);
    if (equals == std::string_view::npos) continue;
    const auto number = read_int(line.substr(word + 5, equals - word - 5));
    if (!number) continue;
    Heading turn{.speaker = sent ? Speaker::host : Speaker::device,
                 .number = *number,
                 .begin = word,
                 .end = equals + 2};
    if (turn.end < line.size() && line[turn.end] == ' ') ++turn.end;
    return turn;
  }
  return std::nullopt;
}

Dialogue parse_sent_and_received(std::string_view text) {
  Dialogue records;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_line_end(text.substr(0, end));
    const bool last = end == text.size();
    text.remove_prefix(std::min(end + 1, text.size()));
    if (const auto turn = turn_on(line)) {
      records.push_back({turn->speaker, turn->number, std::string(line.substr(turn->end)), last});
    } else if (!records.empty() && !line.empty()) {
      records.back().bytes += '\n';
      records.back().bytes += line;
      records.back().cut_off = last;
    }
  }
  for (DialogueRecord& record : records) {
    if (record.bytes.find("\\x") != std::string::npos) record.bytes = without_escapes(record.bytes);
    if (!record.bytes.empty() && !record.bytes.ends_with('\r')) record.bytes += '\r';
  }
  return records;
}

bool begins_binary(std::string_view bytes) {
  return bytes.starts_with("\xC4\xA5") || bytes.starts_with("\xC8\xA5");
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
      whole.back().cut_off = record.cut_off;
    } else {
      whole.push_back(std::move(record));
    }
  }
  return whole;
}

/// Escapes are what tells a log from the raw notation: a carriage return cannot stand in it otherwise.
bool is_escaped(std::string_view content) {
  return content.find("\\x0D") != std::string_view::npos || content.find("\\x0d") != std::string_view::npos;
}

}  // namespace

Result<Dialogue> parse_dialogue(std::string_view content, std::string_view name) {
  Dialogue records = is_escaped(content) ? parse_log(content) : parse_raw(content);
  if (Dialogue turns = parse_sent_and_received(content); turns.size() > records.size())
    records = std::move(turns);
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
  if (!in || std::filesystem::is_directory(file))  // which opens all the same
    return fail("dialogue " + file.string() + " cannot be opened; a readable file is wanted");
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) return fail("dialogue " + file.string() + " cannot be read; a readable file is wanted");
  return parse_dialogue(content, file.string());
}

}  // namespace orcart::ndi
