// One look-up table for all pictures: each pixel of the pinhole picture is asked of the lens.
#include "tools/calibration/rectify.hpp"
#include "tools/calibration/load_picture.hpp"

#include <map>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "firmware-host/files/whole_file.hpp"

namespace orcart {
namespace {

void fill_table(const ScopeModel& scope, cv::Mat& table) {
  table.create(scope.height_px, scope.width_px, CV_32FC2);
  const Lens& lens = scope.lens;
  for (int y = 0; y < table.rows; ++y)
    for (int x = 0; x < table.cols; ++x) {
      const auto seen = project(lens, {(x - lens.cx_px) / lens.fx_px, (y - lens.cy_px) / lens.fy_px, 1});
      table.at<cv::Vec2f>(y, x) =
          seen ? cv::Vec2f(static_cast<float>(seen->x()), static_cast<float>(seen->y()))
               : cv::Vec2f(-1e4F, -1e4F);
    }
}

std::filesystem::path straightened(const std::filesystem::path& image, const std::filesystem::path& folder) {
  return folder / (image.stem().string() + ".png");
}

/// No picture may take the place of one that is read, or of another's answer.
Result<void> check_places(const std::vector<std::filesystem::path>& images,
                          const std::filesystem::path& folder) {
  const auto place = [](const std::filesystem::path& file) {
    std::error_code unreadable;
    const auto whole = std::filesystem::weakly_canonical(file, unreadable);
    return unreadable ? file : whole;
  };
  std::map<std::filesystem::path, std::filesystem::path> read, written;
  for (const auto& image : images) read.emplace(place(image), image);
  for (const auto& image : images) {
    const auto out = place(straightened(image, folder));
    if (const auto lost = read.find(out); lost != read.end())
      return fail(lost->second.string() + ": would be written over by the rectified " + image.string() +
                  "; another folder is accepted");
    if (const auto [other, alone] = written.emplace(out, image); !alone)
      return fail(image.string() + " and " + other->second.string() + " would both become " + out.string() +
                  "; pictures of different names are accepted");
  }
  return {};
}

}  // namespace

Result<void> rectify(const std::vector<std::filesystem::path>& images, const ScopeModel& scope,
                     const std::filesystem::path& folder) {
  if (auto apart = check_places(images, folder); !apart) return apart;
  std::vector<cv::Mat> pictures;
  for (const auto& image : images) {
    pictures.push_back(load_picture(image));
    if (pictures.back().empty())
      return fail(image.string() + ": cannot be read as a picture; PNG, JPEG, TIFF and BMP are accepted");
    if (pictures.back().cols != scope.width_px || pictures.back().rows != scope.height_px)
      return fail(image.string() + ": " + std::to_string(pictures.back().cols) + "x" +
                  std::to_string(pictures.back().rows) + " px; the scope's " +
                  std::to_string(scope.width_px) + "x" + std::to_string(scope.height_px) + " are accepted");
  }
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (trouble)
    return fail(folder.string() + ": cannot be made (" + trouble.message() +
                "); a folder that can be written is accepted");
  cv::Mat table, straight;
  fill_table(scope, table);
  for (std::size_t i = 0; i < images.size(); ++i) {
    cv::remap(pictures[i], straight, table, cv::noArray(), cv::INTER_LINEAR);
    std::vector<uchar> bytes;
    cv::imencode(".png", straight, bytes);
    if (auto written = write_whole_file(straightened(images[i], folder), std::as_bytes(std::span(bytes)));
        !written)
      return written;
  }
  return {};
}

}  // namespace orcart
