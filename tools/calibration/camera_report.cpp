// Three forms of one answer; none of them computes anything that the others do not show.
#include "tools/calibration/camera_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "firmware-host/files/lens_rows.hpp"
#include "tools/calibration/load_picture.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/report_page.hpp"

namespace orcart {
namespace {

const char* word_for(LensModel model) {
  switch (model) {
    case LensModel::fisheye:
      return "fisheye";
    case LensModel::poly4:
      return "poly4";
    case LensModel::brown:
      break;
  }
  return "brown";
}

double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

std::string view_line(const BoardView& view, const ViewFit& fit) {
  return json::format("  %-32s %4zu corners  %6.3f px  %7.4f mm  %7.1f mm away  %4.1f deg tilted%s%s\n",
                      view.image.filename().c_str(), view.corners.size(), fit.rms_px, fit.rms_mm,
                      fit.distance_mm, degrees(fit.tilt_rad), view.remark.empty() ? "" : "  ",
                      view.remark.c_str());
}

Eigen::Vector2d residual_px(const CameraCalibration& c, std::size_t view, const BoardCorner& corner) {
  const auto seen = project(c.scope.lens, (c.fit.views[view].X_CB * Point<B>{corner.board_mm}).mm);
  return seen ? Eigen::Vector2d(*seen - corner.pixel_px) : Eigen::Vector2d::Zero();
}

cv::Point whole(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

/// The picture with the corners found, residuals twenty times as long, and the mask.
cv::Mat drawn(const CameraCalibration& c, std::size_t view) {
  cv::Mat picture = load_picture(c.views[view].image);
  const int thick = std::max(1, picture.cols / 700);
  for (const BoardCorner& corner : c.views[view].corners) {
    cv::circle(picture, whole(corner.pixel_px), 4 * thick, {60, 200, 60}, thick, cv::LINE_AA);
    cv::line(picture, whole(corner.pixel_px), whole(corner.pixel_px + 20 * residual_px(c, view, corner)),
             {40, 40, 255}, thick, cv::LINE_AA);
  }
  const CircularMask& m = c.scope.mask;
  cv::ellipse(picture, whole({m.cx_px, m.cy_px}),
              {static_cast<int>(m.radius_px),
               static_cast<int>(m.radius_px * c.scope.lens.fy_px / c.scope.lens.fx_px)},
              0, 0, 360, {255, 160, 0}, thick, cv::LINE_AA);
  cv::Mat small;
  const double scale = std::min(1.0, 640.0 / picture.cols);
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  return small;
}

/// All corners on the view (left) and residual lengths against the distance from the mask's centre (right).
std::string plots(const CameraCalibration& c) {
  const double width = 420, height = width * c.scope.height_px / c.scope.width_px,
               scale = width / c.scope.width_px;
  std::string where = json::format(
      "<svg width='%.0f' height='%.0f'><rect width='100%%' height='100%%' fill='#f4f4f4'/>", width, height);
  where +=
      json::format("<ellipse cx='%.1f' cy='%.1f' rx='%.1f' ry='%.1f' fill='none' stroke='#07a'/>",
                   c.scope.mask.cx_px * scale, c.scope.mask.cy_px * scale, c.scope.mask.radius_px * scale,
                   c.scope.mask.radius_px * scale * c.scope.lens.fy_px / c.scope.lens.fx_px);
  std::string lengths = "<svg width='420' height='260'><rect width='100%' height='100%' fill='#f4f4f4'/>";
  double longest = 0.1;
  for (const ViewFit& view : c.fit.views) longest = std::max(longest, view.worst_px);
  for (std::size_t v = 0; v < c.views.size(); ++v)
    for (const BoardCorner& corner : c.views[v].corners) {
      where += json::format("<circle cx='%.1f' cy='%.1f' r='1.4' fill='#2a2'/>", corner.pixel_px.x() * scale,
                            corner.pixel_px.y() * scale);
      const double radius =
          std::hypot(corner.pixel_px.x() - c.scope.mask.cx_px, corner.pixel_px.y() - c.scope.mask.cy_px);
      lengths += json::format("<circle cx='%.1f' cy='%.1f' r='1.4' fill='#c22'/>",
                              410 * radius / c.scope.mask.radius_px,
                              255 - 240 * residual_px(c, v, corner).norm() / longest);
    }
  lengths += json::format(
      "<text x='6' y='16' font-size='12'>residual, up to %.2f px, by distance from the mask&#39;s "
      "centre</text>",
      longest);
  return where + "</svg> " + lengths + "</svg>";
}

}  // namespace

std::string picture_url(const cv::Mat& picture) {
  std::vector<uchar> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 82});
  return picture_data_url("jpeg", std::as_bytes(std::span(bytes)));
}

std::string camera_text(const CameraCalibration& c) {
  const Lens& lens = c.scope.lens;
  std::string out =
      json::format("%s  %zu views, %zu corners: RMS %.4f px, %.4f mm on the board\n", word_for(lens.model),
                   c.views.size(), c.fit.corners, c.fit.rms_px, c.fit.rms_mm);
  out += json::format("  f %.3f %.3f (+- %.3f %.3f) px   c %.3f %.3f (+- %.3f %.3f) px\n  coefficients",
                      lens.fx_px, lens.fy_px, c.fit.deviations[0], c.fit.deviations[1], lens.cx_px,
                      lens.cy_px, c.fit.deviations[2], c.fit.deviations[3]);
  for (const double k : lens.coefficients) out += json::format(" %.6g", k);
  if (lens.model == LensModel::poly4)
    out += json::format("  distortion centre %.2f %.2f px", lens.distortion_centre_px.x(),
                        lens.distortion_centre_px.y());
  out += json::format(
      "\n  %s %.1f %.1f, radius %.1f px; view %.1f degrees wide; monotone to %.1f degrees off axis\n",
      c.mask.circle ? "circle" : "no circle: whole picture,", c.scope.mask.cx_px, c.scope.mask.cy_px,
      c.scope.mask.radius_px, 2 * degrees(c.scope.cone_half_angle_rad), degrees(lens.max_angle_rad));
  if (c.mask.notch_rad)
    out += json::format("  notch at %.1f degrees from x towards y\n", degrees(*c.mask.notch_rad));
  out += c.vignetting_known ? json::format("  vignetting cos^%.2f\n", c.scope.fall_off.vignetting_cos_power)
                            : std::string("  vignetting not told by these pictures\n");
  for (std::size_t v = 0; v < c.views.size(); ++v) out += view_line(c.views[v], c.fit.views[v]);
  for (const BoardView& view : c.unused)
    out += "  " + view.image.filename().string() + " is not used: " + view.remark + "\n";
  for (const std::string& note : c.notes) out += "  note: " + note + "\n";
  for (const std::string& hint : c.hints) out += "  hint: " + hint + "\n";
  return out;
}

std::string camera_json(const CameraCalibration& c) {
  const Lens& lens = c.scope.lens;
  std::vector<std::string> views, unused, notes, hints, rows;
  for (std::size_t v = 0; v < c.views.size(); ++v) {
    const ViewFit& fit = c.fit.views[v];
    views.push_back(
        "{\"image\": " + json::text(c.views[v].image.string()) + ", \"corners\": " +
        std::to_string(c.views[v].corners.size()) + ", \"dropped\": " + std::to_string(fit.dropped) +
        ", \"rms_px\": " + json::number(fit.rms_px) + ", \"worst_px\": " + json::number(fit.worst_px) +
        ", \"rms_mm\": " + json::number(fit.rms_mm) + ", \"distance_mm\": " + json::number(fit.distance_mm) +
        ", \"tilt_rad\": " + json::number(fit.tilt_rad) + ", \"X_CB\": " + json::pose(fit.X_CB) + "}");
  }
  for (const BoardView& view : c.unused)
    unused.push_back("{\"image\": " + json::text(view.image.string()) +
                     ", \"why\": " + json::text(view.remark) + "}");
  for (const std::string& note : c.notes) notes.push_back(json::text(note));
  for (const std::string& hint : c.hints) hints.push_back(json::text(hint));
  if (c.scope.lens_covariance) {
    const LensCovariance& covariance = *c.scope.lens_covariance;
    const std::vector<int> free = lens_rows(lens.model, covariance);
    for (const int i : free) rows.push_back(json::numbers(Eigen::VectorXd(covariance.row(i)(free))));
  }
  return "{\"model\": " + json::text(word_for(lens.model)) + ", \"rms_px\": " + json::number(c.fit.rms_px) +
         ", \"rms_mm\": " + json::number(c.fit.rms_mm) + ", \"corners\": " + std::to_string(c.fit.corners) +
         ",\n \"fx_px\": " + json::number(lens.fx_px) + ", \"fy_px\": " + json::number(lens.fy_px) +
         ", \"cx_px\": " + json::number(lens.cx_px) + ", \"cy_px\": " + json::number(lens.cy_px) +
         ", \"coefficients\": " + json::numbers(lens.coefficients) + ", \"distortion_centre_px\": " +
         json::numbers(std::array{lens.distortion_centre_px.x(), lens.distortion_centre_px.y()}) +
         ",\n \"deviations\": " + json::numbers(c.fit.deviations) + ", \"covariance\": " + json::list(rows) +
         ",\n \"mask\": {\"circle\": " + (c.mask.circle ? "true" : "false") +
         ", \"cx_px\": " + json::number(c.scope.mask.cx_px) +
         ", \"cy_px\": " + json::number(c.scope.mask.cy_px) +
         ", \"radius_px\": " + json::number(c.scope.mask.radius_px) +
         ", \"notch_rad\": " + json::number(c.mask.notch_rad.value_or(NAN)) +
         "},\n \"cone_half_angle_rad\": " + json::number(c.scope.cone_half_angle_rad) +
         ", \"max_angle_rad\": " + json::number(lens.max_angle_rad) + ", \"vignetting_cos_power\": " +
         json::number(c.vignetting_known ? c.scope.fall_off.vignetting_cos_power : NAN) +
         ", \"covered\": " + json::number(c.covered) + ",\n \"views\": " + json::list(views) +
         ",\n \"unused\": " + json::list(unused) + ",\n \"notes\": " + json::list(notes) +
         ",\n \"hints\": " + json::list(hints) + "}\n";
}

Result<std::string> camera_page(const CameraCalibration& c) {
  std::string body =
      "<p>" + html_escaped(c.scope.calibrated_on) + "</p>" + plots(c) +
      "<h2>The board in each picture</h2><p>Green: corners found. Red: residuals, twenty times as "
      "long. Blue: the mask.</p>";
  for (std::size_t v = 0; v < c.views.size(); ++v)
    body += "<figure><img src='" + picture_url(drawn(c, v)) + "'><figcaption>" +
            html_escaped(c.views[v].image.filename().string()) +
            json::format(": %.3f px, %.4f mm", c.fit.views[v].rms_px, c.fit.views[v].rms_mm) +
            "</figcaption></figure>";
  return html_page({"Camera calibration: " + c.scope.name, camera_text(c), body});
}

}  // namespace orcart
