// The calibration's texts go through the very readers of the files they were.
#include "tools/evaluate/session/recorded_session.hpp"

#include <unistd.h>

#include <algorithm>

#include "firmware-host/files/whole_file.hpp"
#include "realtime/optics/scope_turn.hpp"

namespace orcart {

namespace {

/// Lets a reader of files read a text of the session.
template <class Reader>
auto read_text(const std::string& text, const std::filesystem::path& session, const char* name,
               const Reader& read) -> decltype(read(session)) {
  std::string folder = (std::filesystem::temp_directory_path() / "orcart-session-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) return fail(folder + ": cannot be made");
  const std::filesystem::path file = std::filesystem::path(folder) / name;
  auto made = write_whole_file(file, text);
  auto result = made ? read(file) : decltype(read(file))(tl::unexpected(made.error()));
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  if (!result) return fail(session.string() + ": its " + name + " cannot be used: " + result.error().message);
  return result;
}

/// Where the first luma byte lies and how far the next.
struct LumaPlace {
  std::size_t first = 0, step = 1;
};

LumaPlace luma_of(PixelFormat format) {
  if (format == PixelFormat::yuyv) return {.first = 0, .step = 2};
  if (format == PixelFormat::uyvy) return {.first = 1, .step = 2};
  return {};
}

std::uint8_t grey_of_rgb(const std::byte* p, PixelFormat format) {
  const auto at = [p](int i) { return std::to_integer<int>(p[i]); };
  const int red = format == PixelFormat::rgba8888 ? at(0) : at(2),
            blue = format == PixelFormat::rgba8888 ? at(2) : at(0);
  return static_cast<std::uint8_t>((3 * red + 6 * at(1) + blue) / 10);
}

}  // namespace

Result<Picture> grey_of(const StoredPicture& stored) {
  const std::size_t pixels =
      static_cast<std::size_t>(stored.width_px) * static_cast<std::size_t>(stored.height_px);
  if (stored.bytes.empty() ||
      stored.bytes.size() != packed_bytes(stored.format, stored.width_px, stored.height_px))
    return fail("a picture of " + std::to_string(stored.bytes.size()) + " bytes is not " +
                std::to_string(stored.width_px) + "x" + std::to_string(stored.height_px));
  const bool rgb = stored.format == PixelFormat::rgba8888 || stored.format == PixelFormat::xrgb8888;
  const LumaPlace luma = luma_of(stored.format);
  Picture picture{.width_px = stored.width_px, .height_px = stored.height_px, .rgba = {}};
  picture.rgba.reserve(4 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t grey = rgb ? grey_of_rgb(&stored.bytes[4 * i], stored.format)
                                  : std::to_integer<std::uint8_t>(stored.bytes[luma.first + luma.step * i]);
    picture.rgba.insert(picture.rgba.end(), {grey, grey, grey, 255});
  }
  return picture;
}

Result<RecordedSession> RecordedSession::open(const std::filesystem::path& file) {
  auto reader = SessionReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  RecordedSession session(*std::move(reader));
  session.name_ = file.string();
  const auto meta = session.reader_.meta();
  if (!meta) return tl::unexpected(meta.error());
  session.started_at_ = meta->started_at;
  if (meta->tracker_against_video_deviation)
    session.time_deviation_s_ = seconds(*meta->tracker_against_video_deviation);
  session.turn_deviation_rad_ = meta->turn_deviation_rad;
  const auto calibration = session.reader_.calibration();
  if (!calibration) return tl::unexpected(calibration.error());
  auto scope = read_text(calibration->scope_toml, file, "scope.toml",
                         [](const std::filesystem::path& f) { return read_scope(f); });
  if (!scope) return tl::unexpected(scope.error());
  auto registration = read_text(calibration->registration_toml, file, "registration.toml",
                                [](const std::filesystem::path& f) { return read_registration(f); });
  if (!registration) return tl::unexpected(registration.error());
  session.turn_rad_ = meta->turn_rad;
  session.scope_ = turned(*scope, meta->turn_rad);
  session.registration_ = *std::move(registration);
  session.surface_hash_ = calibration->surface_hash;
  auto captures = session.reader_.captures();
  if (!captures) return tl::unexpected(captures.error());
  for (StoredCapture& capture : *captures) {
    if (capture.undone) {
      ++session.undone_;
    } else {
      session.captures_.push_back(capture);
    }
  }
  return session;
}

bool RecordedSession::turned_on_the_way() const {
  return std::ranges::any_of(captures_, [](const StoredCapture& c) { return c.facts.turn_rad != 0; });
}

Result<TakenPicture> RecordedSession::taken(const StoredCapture& capture) {
  const auto stored = reader_.picture(capture.id);
  if (!stored) return tl::unexpected(stored.error());
  const std::string name = name_ + ": capture " + std::to_string(capture.id);
  if (stored->width_px != scope_.width_px || stored->height_px != scope_.height_px)
    return fail(name + " is " + std::to_string(stored->width_px) + "x" + std::to_string(stored->height_px) +
                " pixels; the session's passport is for " + std::to_string(scope_.width_px) + "x" +
                std::to_string(scope_.height_px));
  auto picture = grey_of(*stored);
  if (!picture) return fail(name + ": " + picture.error().message);
  return TakenPicture{.picture = *std::move(picture), .X_MC = capture.facts.X_MC};
}

}  // namespace orcart
