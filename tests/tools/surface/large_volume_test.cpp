// How long a clinical CT takes, and how much memory: 512 x 512 x 300 with a folded brain in it.
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/surface/surface_command.hpp"

namespace orcart {
namespace {

/// The paper's CT, 0.488 x 0.488 x 1 mm, as a MetaImage: a ball of 70 mm with folds of 4 mm, noise on
/// top.
void write_head(const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  out << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
         "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = -124.9 -124.9 -149.5\nElementSpacing = 0.488 0.488 "
         "1\n"
         "DimSize = 512 512 300\nElementType = MET_SHORT\nElementDataFile = LOCAL\n";
  std::vector<std::int16_t> slice(512UL * 512UL);
  std::uint32_t noise = 1;
  for (int k = 0; k < 300; ++k) {
    for (int j = 0; j < 512; ++j)
      for (int i = 0; i < 512; ++i) {
        const float x = 0.488F * static_cast<float>(i) - 124.9F, y = 0.488F * static_cast<float>(j) - 124.9F,
                    z = static_cast<float>(k) - 149.5F;
        const float folds = 4 * std::sin(x / 4) * std::sin(y / 4) * std::sin(z / 4);
        noise = noise * 1664525U + 1013904223U;
        const bool inside = std::sqrt(x * x + y * y + z * z) < 70 + folds;
        slice[static_cast<std::size_t>(i + 512 * j)] =
            static_cast<std::int16_t>((inside ? 40 : -200) + static_cast<int>(noise >> 28U));
      }
    out.write(reinterpret_cast<const char*>(slice.data()),
              static_cast<std::streamsize>(slice.size() * sizeof slice[0]));
  }
}

TEST(LargeVolume, TakesThisLongAndThisMuch) {
  const TemporaryFolder folder;
  write_head(folder / "head.mha");
  SurfaceCommand command;
  command.volume.path = folder / "head.mha";
  command.region = {.seeds_mm = {{0, 0, 0}}, .lowest = 0, .highest = 100};
  command.output.out = folder / "brain.ply";
  const auto began = std::chrono::steady_clock::now();
  auto last = began;
  const auto report = make_surface_file(command, [&](int step, int, const std::string& what) {
    const auto now = std::chrono::steady_clock::now();
    std::printf("%6.1f s before step %d, %s\n", std::chrono::duration<double>(now - last).count(), step,
                what.c_str());
    last = now;
  });
  ASSERT_TRUE(report) << report.error().message;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "512x512x300: %.1f s by the clock, %.1f s of processor, %.2f GB at most, %zu triangles of %zu, "
      "deviation %.3f mm mean, %.3f max\n",
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(),
      static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec),
      static_cast<double>(usage.ru_maxrss) / 1048576, report->mesh.triangles, report->triangles_before,
      report->thinning.mean_mm, report->thinning.max_mm);
  EXPECT_TRUE(report->closed);
  EXPECT_NEAR(report->mesh.volume_ml, 4.0 / 3 * M_PI * 343, 0.03 * 4.0 / 3 * M_PI * 343);
}

}  // namespace
}  // namespace orcart
