// Walks the elements of a DICOM file without taking in what they hold.
#include "tools/volume/dicom_bytes.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace orcart {

namespace {

using namespace std::string_view_literals;

/// A number at a place of a file in memory; 0 beyond its end.
std::uint32_t little_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < count && at + i < bytes.size(); ++i)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return number;
}

/// Where the data set begins and how it is written, or nothing where that is not a plain little-endian one.
struct SetStart {
  std::size_t at = 0;
  bool implicit = false, plain = true;
};

/// A file without the 128 bytes and `DICM` in front, as software of the 1990s wrote them: its first two
/// elements are of group 8, in order.
std::optional<SetStart> bare_start(std::string_view bytes) {
  if (bytes.size() < 16 || little_at(bytes, 0, 2) != 8) return std::nullopt;
  const auto capital = [&](std::size_t at) { return bytes[at] >= 'A' && bytes[at] <= 'Z'; };
  const bool named = capital(4) && capital(5);
  const std::uint32_t length = named ? little_at(bytes, 6, 2) : little_at(bytes, 4, 4);
  if (length > bytes.size() || 8 + length + 4 > bytes.size()) return std::nullopt;
  const std::size_t next = 8 + length;
  if (little_at(bytes, next, 2) != 8 || little_at(bytes, next + 2, 2) <= little_at(bytes, 2, 2))
    return std::nullopt;
  return SetStart{.at = 0, .implicit = !named};
}

/// What comes at a place: an element, an item of a sequence, or the end of either.
struct Element {
  std::uint32_t group = 0, number = 0, length = 0;
  std::size_t head = 8;  ///< bytes before the value
  /// Its kind is UN; is SQ; is one of DICOM's; may go without a length.
  bool unknown = false, sequence = false, known = false, may_be_open = false;

  bool open_ended() const { return length == 0xFFFFFFFFU; }
};

Element element_at(std::string_view bytes, std::size_t at, bool implicit) {
  Element element{.group = little_at(bytes, at, 2), .number = little_at(bytes, at + 2, 2)};
  const bool marker = element.group == 0xFFFE;
  const std::string_view kind = bytes.substr(at + 4, 2);
  const bool wide =
      !implicit && !marker && "OB OD OF OL OV OW SQ SV UC UN UR UT UV"sv.find(kind) != std::string_view::npos;
  if (wide) element.head = 12;
  element.length = implicit || marker ? little_at(bytes, at + 4, 4)
                   : wide             ? little_at(bytes, at + 8, 4)
                                      : little_at(bytes, at + 6, 2);
  const bool narrow =
      "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US"sv.find(kind) != std::string_view::npos;
  element.unknown = wide && kind == "UN";
  element.sequence = wide && kind == "SQ";
  element.known = wide || narrow;
  element.may_be_open = element.unknown || element.sequence || (wide && (kind == "OB" || kind == "OW"));
  return element;
}

/// Whether the group of elements in front, which tells how the rest is written, is what its length says: GDCM
/// aborts where it is not.
bool sound_front(std::string_view front) {
  std::size_t at = 0;
  while (at < front.size()) {
    if (at + 8 > front.size() || little_at(front, at, 2) != 2) return false;
    const std::string_view kind = front.substr(at + 4, 2);
    if (kind != "OB" && kind != "UI" && kind != "SH" && kind != "AE" && kind != "UL" && kind != "UR")
      return false;
    const Element element = element_at(front, at, false);
    if (at == 0 && (element.number != 0 || kind != "UL" || element.length != 4)) return false;
    at += element.head + element.length;
  }
  return at == front.size();
}

std::optional<SetStart> set_start(std::string_view bytes) {
  constexpr std::size_t kMetaAt = 132;
  if (bytes.substr(0, kMetaAt).substr(std::min<std::size_t>(bytes.size(), 128)) != "DICM")
    return bare_start(bytes);
  if (bytes.size() < kMetaAt + 12 || little_at(bytes, kMetaAt, 4) != 2) return std::nullopt;
  const std::size_t set_at = kMetaAt + 12 + little_at(bytes, kMetaAt + 8, 4);
  const std::string_view meta = bytes.substr(kMetaAt, set_at - kMetaAt);
  if (set_at + 8 > bytes.size() || !sound_front(meta)) return std::nullopt;
  const bool big = meta.find("1.2.840.10008.1.2.2"sv) != std::string_view::npos,
             deflated = meta.find("1.2.840.10008.1.2.1.99"sv) != std::string_view::npos;
  return SetStart{.at = set_at,
                  .implicit = meta.find("1.2.840.10008.1.2\0"sv) != std::string_view::npos,
                  .plain = !big && !deflated};
}

/// Goes from element to element, down into what has no length of its own and into the functional groups,
/// which are looked at one by one: they are what an enhanced file lives by.
class Walk {
 public:
  Walk(std::string_view bytes, const SetStart& start) : bytes_(bytes), at_(start.at) {
    levels_.push_back({.holds = Holds::elements, .end = bytes.size(), .implicit = start.implicit});
  }

  DicomExtent go() {
    while (step()) {
    }
    // Some packers leave the end of the pieces out; with one piece, nothing can be missing.
    const bool closed = levels_.size() == 1 || (levels_.back().holds == Holds::pieces && pieces_ == 2);
    return {.whole = sound_ && closed && at_ == bytes_.size(), .has_pixels = has_pixels_};
  }

 private:
  enum class Holds : std::uint8_t { elements, items, pieces };
  struct Level {
    Holds holds = Holds::elements;
    std::size_t end = 0;  ///< a place that it does not reach beyond, or its own end
    bool open_ended = false, implicit = false, close_look = false;
  };

  bool step() {
    while (levels_.size() > 1 && !levels_.back().open_ended && at_ == levels_.back().end) levels_.pop_back();
    const Level level = levels_.back();
    if (at_ >= bytes_.size()) return false;
    if (at_ + 8 > level.end) return sound_ = false;
    const Element element = element_at(bytes_, at_, level.implicit);
    at_ += element.head;
    if (at_ > level.end || (!element.open_ended() && element.length > level.end - at_)) return sound_ = false;
    sound_ = element.group == 0xFFFE ? take_marker(element, level)
                                     : level.holds == Holds::elements && take_element(element, level);
    return sound_;
  }

  bool take_marker(const Element& marker, const Level& level) {
    constexpr std::uint32_t kItem = 0xE000, kItemEnd = 0xE00D, kSequenceEnd = 0xE0DD;
    const bool ends = marker.number == (level.holds == Holds::elements ? kItemEnd : kSequenceEnd);
    if (ends && level.open_ended && marker.length == 0) {
      levels_.pop_back();
      return true;
    }
    if (marker.number != kItem || level.holds == Holds::elements) return false;
    if (level.holds == Holds::items) return go_down(Holds::elements, marker, level, level.close_look);
    ++pieces_;
    at_ += marker.length;
    return !marker.open_ended();
  }

  bool take_element(const Element& element, const Level& level) {
    constexpr std::uint32_t kPixels = 0x7FE0, kFunctionalGroups = 0x5200;
    const bool pixels = element.group == kPixels && levels_.size() == 1;
    has_pixels_ = has_pixels_ || pixels;
    if (level.close_look && !level.implicit && !element.known) return false;
    if (element.open_ended()) {
      if (!element.may_be_open && !level.implicit) return false;
      return go_down(pixels ? Holds::pieces : Holds::items, element, level, level.close_look);
    }
    const bool own = element.group % 2 == 0;  // of DICOM; what makers add need not follow the rules
    if (element.sequence && own && (level.close_look || element.group == kFunctionalGroups))
      return go_down(Holds::items, element, level, true);
    at_ += element.length;
    return true;
  }

  bool go_down(Holds holds, const Element& element, const Level& level, bool close_look) {
    constexpr std::size_t kDeepest = 64;  // GDCM goes down by recursion
    const bool open_ended = element.open_ended();
    levels_.push_back({.holds = holds,
                       .end = open_ended ? level.end : at_ + element.length,
                       .open_ended = open_ended,
                       .implicit = level.implicit || (open_ended && element.unknown),  // PS3.5, 6.2.2
                       .close_look = close_look});
    return levels_.size() <= kDeepest;
  }

  std::string_view bytes_;
  std::size_t at_ = 0, pieces_ = 0;  ///< pieces of compressed pixels, and the table before them
  std::vector<Level> levels_;
  bool sound_ = true, has_pixels_ = false;
};

}  // namespace

bool begins_as_dicom(std::string_view bytes) {
  return bytes.substr(std::min<std::size_t>(bytes.size(), 128)).starts_with("DICM") || bare_start(bytes);
}

DicomExtent extent_of_dicom(std::string_view bytes) {
  const auto start = set_start(bytes);
  if (!start || !start->plain) return {.whole = start.has_value(), .has_pixels = start.has_value()};
  return Walk(bytes, *start).go();
}

}  // namespace orcart
