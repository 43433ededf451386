// Counts a dialogue record by record.
#include "firmware-host/tracker/ndi/dialogue_figures.hpp"

#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/framing.hpp"
#include "firmware-host/tracker/ndi/hex.hpp"
#include "firmware-host/tracker/ndi/words.hpp"
#include "realtime/base/crc16.hpp"

namespace orcart::ndi {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span{text.data(), text.size()});
}

constexpr std::size_t kLongestRecorded = 1u << 20;

/// A reply at a recording's end may be whole all the same: in one notation its carriage return is the line's
/// end.
bool is_whole(std::string_view bytes) {
  return find_ascii_reply(bytes_of(bytes)).status == FrameStatus::complete;
}

/// `TX:0001C19B\r` is TX with 0001.
struct Question {
  std::string_view name;
  std::uint16_t options = kTransforms;
};

Question question_of(std::string_view command) {
  const std::size_t colon = command.find_first_of(": \r\n");
  Question question{.name = command.substr(0, colon)};
  if (colon == std::string_view::npos || command.size() < colon + 5) return question;
  const bool has_options = command[colon] == ' ' || command.size() >= colon + 9;
  const auto options = has_options ? parse_hex(command.substr(colon + 1, 4)) : std::nullopt;
  if (options) question.options = static_cast<std::uint16_t>(*options);
  return question;
}

class Counter {
 public:
  DialogueFigures count(const Dialogue& dialogue) {
    for (const DialogueRecord& record : dialogue) {
      if (record.speaker == Speaker::host) {
        take_command(record);
      } else {
        take_reply(record);
      }
    }
    leave_unanswered();
    return std::move(figures_);
  }

 private:
  void remark(const DialogueRecord& record, const std::string& what) {
    figures_.remarks.push_back("record " + std::to_string(record.number) + ": " + what);
  }

  void leave_unanswered() {
    if (open_ == nullptr) return;
    ++figures_.unanswered;
    remark(*open_, "no reply to " + std::string(question_of(open_->bytes).name));
    open_ = nullptr;
  }

  void take_command(const DialogueRecord& record) {
    leave_unanswered();
    open_ = &record;
    ++figures_.commands;
    if (record.cut_off && !is_whole(record.bytes))
      return remark(record, "the recording ends in the middle of a command");
    const std::size_t mark = record.bytes.find_first_of(": ");
    const bool has_crc = mark != std::string::npos && record.bytes[mark] == ':';
    if (!has_crc) return;
    const bool good = find_ascii_reply(bytes_of(record.bytes)).status == FrameStatus::complete;
    count_crc(good, record, "command");
  }

  void count_crc(bool good, const DialogueRecord& record, std::string_view what) {
    if (good) {
      ++figures_.crc_good;
    } else {
      ++figures_.crc_bad;
      remark(record, "bad CRC of the " + std::string(what));
    }
  }

  void take_reply(const DialogueRecord& record) {
    ++figures_.replies;
    const Question question = open_ != nullptr ? question_of(open_->bytes) : Question{};
    open_ = nullptr;
    if (record.cut_off && !is_whole(record.bytes)) {
      remark(record, "the recording ends in the middle of a reply");
    } else if (binary_header_bytes(bytes_of(record.bytes)) > 0) {
      take_binary(record, question);
    } else {
      take_text(record, question);
    }
  }

  void take_binary(const DialogueRecord& record, const Question& question) {
    const auto bytes = bytes_of(record.bytes);
    const std::size_t header_bytes = binary_header_bytes(bytes);
    const bool header = bytes.size() >= header_bytes && crc16(bytes.first(header_bytes)) == 0;
    count_crc(header, record, "reply's header");
    const ReplyFrame frame = find_binary_reply(bytes, kLongestRecorded);
    const bool body = header && frame.status == FrameStatus::complete;
    count_crc(body, record, "reply's body");
    if (!body) return;
    if (question.name == "BX") take_tracking(record, parse_bx(frame.payload, question.options));
    if (question.name == "BX2") take_tracking(record, parse_bx2(frame.payload));
  }

  /// The old command has no handles: a line for each of its ports.
  void take_lines(std::string_view text, std::size_t handle_letters) {
    constexpr std::size_t kTransformLetters = 51;
    for (std::size_t end = 0; !text.empty(); text.remove_prefix(std::min(end + 1, text.size()))) {
      end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      line.remove_prefix(std::min(handle_letters, line.size()));
      const bool signed_number = line.starts_with('+') || line.starts_with('-');
      if (signed_number && line.size() >= kTransformLetters) ++figures_.transforms;
      if (line.starts_with("MISSING")) ++figures_.missing;
      if (line.starts_with("DISABLED") || line.starts_with("UNOCCUPIED")) ++figures_.disabled;
    }
  }

  void take_text(const DialogueRecord& record, const Question& question) {
    std::string bytes = record.bytes;
    if (!bytes.ends_with('\r')) {
      ++figures_.unanswered;
      remark(record, "the reply has no carriage return: a host would wait in vain");
      bytes += '\r';
    }
    const ReplyFrame frame = find_ascii_reply(bytes_of(bytes));
    const bool good = frame.status == FrameStatus::complete;
    count_crc(good, record, "reply");
    if (!good) return;
    if (const auto code = error_code(frame.text())) {
      ++figures_.errors;
      remark(record, std::string(question.name) + " was refused: " + std::string(error_word(*code)));
    } else if (question.name == "TX") {
      take_poses_as_text(record, frame.text(), question.options);
    } else if (question.name == "GX") {
      take_lines(frame.text(), 0);
    }
  }

  /// Options that this program does not know only add to a line's end.
  void take_poses_as_text(const DialogueRecord& record, std::string_view text, std::uint16_t options) {
    const auto reply = parse_tx(text, options);
    if (reply) return take_tracking(record, reply);
    constexpr std::size_t kCountLetters = 2, kHandleLetters = 2;
    remark(record, "holds more than the options that were asked for explain");
    take_lines(text.substr(std::min(kCountLetters, text.size())), kHandleLetters);
  }

  void take_tracking(const DialogueRecord& record, const Result<TrackingReply, ReplyFault>& reply) {
    if (!reply) return remark(record, "the reply's CRC is good, but it cannot be read");
    for (const HandleReading& reading : reply->readings()) {
      if (reading.has_transform) {
        ++figures_.transforms;
        figures_.placed.push_back(reading);
      }
      if (reading.status == HandleStatus::missing) ++figures_.missing;
      if (reading.status == HandleStatus::disabled) ++figures_.disabled;
    }
  }

  DialogueFigures figures_;
  const DialogueRecord* open_ = nullptr;
};

}  // namespace

DialogueFigures count_dialogue(const Dialogue& dialogue) {
  return Counter{}.count(dialogue);
}

}  // namespace orcart::ndi
