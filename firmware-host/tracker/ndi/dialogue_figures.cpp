// Counts a dialogue record by record.
#include "firmware-host/tracker/ndi/dialogue_figures.hpp"

#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/framing.hpp"
#include "firmware-host/tracker/ndi/hex.hpp"
#include "firmware-host/tracker/ndi/tracking_reply.hpp"
#include "firmware-host/tracker/ndi/words.hpp"
#include "realtime/base/crc16.hpp"

namespace orcart::ndi {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span{text.data(), text.size()});
}

/// `TX:0001C19B\r` is TX with 0001.
struct Question {
  std::string_view name;
  std::uint16_t options = kTransforms;
};

Question question_of(std::string_view command) {
  const std::size_t colon = command.find_first_of(": \r");
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
    const bool has_crc = record.bytes.find(':') != std::string::npos;
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
    if (bytes_of(record.bytes).size() >= 2 && record.bytes.starts_with("\xC4\xA5")) {
      take_binary(record, question);
    } else {
      take_text(record, question);
    }
  }

  void take_binary(const DialogueRecord& record, const Question& question) {
    const auto bytes = bytes_of(record.bytes);
    const bool header = bytes.size() >= kBinaryHeaderBytes && crc16(bytes.first(kBinaryHeaderBytes)) == 0;
    count_crc(header, record, "reply's header");
    const ReplyFrame frame = find_binary_reply(bytes);
    const bool body = header && frame.status == FrameStatus::complete;
    count_crc(body, record, "reply's body");
    if (body && question.name == "BX") take_tracking(record, parse_bx(frame.payload, question.options));
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
      take_tracking(record, parse_tx(frame.text(), question.options));
    }
  }

  void take_tracking(const DialogueRecord& record, const Result<TrackingReply, ReplyFault>& reply) {
    if (!reply) return remark(record, "the reply's CRC is good, but it cannot be read");
    for (const HandleReading& reading : reply->readings()) {
      if (reading.has_transform) ++figures_.transforms;
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
