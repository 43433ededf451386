// Everything is made in a folder beside, which then takes the name.
#include "tools/evaluate/session/session_export.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "board/sim/picture_png.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "tools/evaluate/session/recorded_session.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {

namespace {

template <class A, class B>
std::string line_of(const std::string& name, const Pose<A, B>& X, const std::string& rest = "") {
  std::string line = name;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      line += json::format(",%.17g", column < 3 ? X.rotation(row, column) : X.translation_mm[row]);
  return line + rest + "\n";
}

/// Six fields; empty where the velocity is not known.
std::string fields_of(const std::optional<Twist>& velocity) {
  std::string fields;
  for (Eigen::Index i = 0; i < 6; ++i) fields += velocity ? json::format(",%.17g", (*velocity)[i]) : ",";
  return fields;
}

Result<void> write_files(RecordedSession& session, const std::filesystem::path& folder,
                         const EvaluateProgress& progress) {
  const Pose<R, M> X_RM = session.registration().X_MR.inverse();
  const bool turned = session.turned_on_the_way();
  const auto& captures = session.captures();
  const bool moving =
      std::ranges::any_of(captures, [](const auto& c) { return c.facts.velocity.has_value(); });
  std::string views = "image,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23", poses;
  views += turned ? ",turn_rad" : "";
  views += moving ? ",vx_mm_s,vy_mm_s,vz_mm_s,wx_rad_s,wy_rad_s,wz_rad_s\n" : "\n";
  for (std::size_t i = 0; i < captures.size(); ++i) {
    progress("writing pictures", static_cast<double>(i) / static_cast<double>(captures.size()));
    const std::string name = json::format("capture-%04d.png", static_cast<int>(captures[i].id));
    auto picture = session.picture(captures[i]);
    if (!picture) return tl::unexpected(picture.error());
    if (auto written = write_picture_png(folder / name, picture->descriptor()); !written) return written;
    const Pose<M, C>& X_MC = captures[i].facts.X_MC;
    const double turn_rad = captures[i].facts.turn_rad;
    views += line_of(name, X_MC,
                     (turned ? json::format(",%.17g", turn_rad) : "") +
                         (moving ? fields_of(captures[i].facts.velocity) : ""));
    poses += line_of(name, X_RM * X_MC * optics_at(session.scope(), turn_rad).X_SC.inverse());
  }
  if (auto written = write_whole_file(folder / "views.csv", views); !written) return written;
  if (auto written = write_whole_file(folder / "poses.csv", poses); !written) return written;
  if (auto written = write_scope(folder / "scope.toml", session.scope()); !written) return written;
  return write_registration(folder / "registration.toml", session.registration());
}

}  // namespace

Result<ExportReport> export_session(const ExportCommand& command, const EvaluateProgress& progress) {
  if (std::filesystem::exists(command.out))
    return fail(command.out.string() + ": is there already; a folder that is not there yet is accepted");
  auto session = RecordedSession::open(command.session);
  if (!session) return tl::unexpected(session.error());
  if (session->captures().empty())
    return fail(command.session.string() + ": holds no capture that was not undone");
  std::filesystem::path scratch = command.out;
  scratch.replace_filename("." + command.out.filename().string() + ".part-" + std::to_string(::getpid()));
  std::error_code trouble;
  std::filesystem::create_directory(scratch, trouble);
  if (trouble) return fail(scratch.string() + ": cannot be made: " + trouble.message());
  auto written = write_files(*session, scratch, progress);
  if (written) {
    std::filesystem::rename(scratch, command.out, trouble);
    if (trouble) written = fail(command.out.string() + ": cannot be made: " + trouble.message());
  }
  if (!written) {
    std::filesystem::remove_all(scratch, trouble);
    return tl::unexpected(written.error());
  }
  return ExportReport{.captures = session->captures().size(),
                      .undone = session->undone(),
                      .turn_rad = session->turn_rad(),
                      .turned = session->turned_on_the_way()};
}

}  // namespace orcart
