// Prints the cart's cutout beside stock VTK, form by form: pose by pose in turns on one processor, in
// processor time, so that other load cancels out, with the triangle counts compared.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <span>
#include <vector>

#include "firmware-host/files/surface_file.hpp"
#include "tools/bench/mapper_bench.hpp"
#include "tools/bench/vtk/stock_mapper.hpp"

namespace orcart {
namespace {

/// Processor time of this thread: a view that the scheduler interrupts costs what it costs alone.
double processor_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// What reading the clock twice takes, about a microsecond: three views as ranges.
double reading_us() {
  std::vector<double> empty;
  for (int i = 0; i < 1001; ++i) {
    const double start = processor_us();
    empty.push_back(processor_us() - start);
  }
  return median(std::move(empty));
}

template <class F>
double time_us(F&& work) {
  static const double reading = reading_us();
  const double start = processor_us();
  work();
  return processor_us() - start - reading;
}

constexpr std::size_t kBlock = 10;  ///< poses to one reading of the clock

/// One form's times, block by block; of a view.
struct Pairs {
  std::vector<double> cart_us, vtk_us, ratio;
  std::uint32_t unequal = 0;  ///< poses whose triangle counts differ

  void add(double cart, double vtk) {
    cart_us.push_back(cart);
    vtk_us.push_back(vtk);
    ratio.push_back(vtk / cart);
  }
  void print(const char* name, const char* counts) const {
    std::printf("%-28s cart %9.2f us   VTK %10.1f us   ratio of pairs: median %7.1f   %s", name,
                median(cart_us), median(vtk_us), median(ratio), counts);
    if (counts[0] == 'e') std::printf(" on all but %u poses", unequal);
    std::printf("\n");
  }
};

struct Bench {
  const Surface& surface;
  ClusterTree tree;
  RayScene rays;
  ScopeModel scope = bench_scope({});
  ConeShape shape{.half_angle_rad = scope.cone_half_angle_rad, .far_mm = scope.far_mm};
  StockMapper stock{surface.mesh, rectified_directions(scope), shape};
  Cutout by_corner{tree, rays, scope, CutoutRule::corner}, touching{tree, rays, scope};
  CutoutMesh mesh{120'000};
  CutoutRanges ranges{tree.cluster_count()};

  std::uint32_t cut(Cutout& cutout, const Pose<M, C>& X_MC, CutoutForm form) {
    std::uint32_t triangles = 0;
    cutout.begin(X_MC, form);
    while (cutout.next(mesh)) triangles += mesh.triangles;
    return triangles;
  }

  /// Blocks of poses in turns. The cart maps the block once before, so that its caches are those of a cart
  /// that runs, as VTK's are after its own first view.
  void form(std::span<const Pose<M, C>> poses, CutoutForm form, Cutout& cutout, const char* name,
            const char* counts) {
    Pairs pairs;
    std::array<std::uint32_t, kBlock> cart_count{}, vtk_count{};
    for (std::size_t first = 0; first + kBlock <= poses.size(); first += kBlock) {
      const auto block = poses.subspan(first, kBlock);
      const double vtk_us = time_us([&] {
        for (std::size_t k = 0; k < kBlock; ++k) {
          const ViewingCone cone = viewing_cone(block[k], shape);
          vtk_count[k] =
              form == CutoutForm::clip ? stock.clip(block[k], cone) : stock.extract(block[k], cone);
        }
      });
      const auto map_block = [&] {
        for (std::size_t k = 0; k < kBlock; ++k) cart_count[k] = cut(cutout, block[k], form);
      };
      map_block();
      pairs.add(time_us(map_block) / kBlock, vtk_us / kBlock);
      for (std::size_t k = 0; k < kBlock; ++k) pairs.unequal += cart_count[k] != vtk_count[k] ? 1 : 0;
    }
    pairs.print(name, counts);
  }

  void form_ranges(std::span<const Pose<M, C>> poses) {
    Pairs pairs;
    for (std::size_t first = 0; first + kBlock <= poses.size(); first += kBlock) {
      const auto block = poses.subspan(first, kBlock);
      const double vtk_us = time_us([&] {
        for (const auto& X_MC : block) stock.project(X_MC);
      });
      const auto map_block = [&] {
        for (const auto& X_MC : block) touching.ranges(X_MC, ranges);
      };
      map_block();
      pairs.add(time_us(map_block) / kBlock, vtk_us / kBlock);
    }
    pairs.print("ranges / projected texture", "whole mesh on VTK's side");
  }
};

int run(const char* surface_file, const char* poses_file) {
  const auto surface = read_surface(surface_file, nullptr, Space::lps);
  const auto poses = read_bench_poses(poses_file);
  if (!surface || !poses) {
    std::fprintf(stderr, "orcart_bench_vtk: %s\n",
                 (!surface ? surface.error() : poses.error()).message.c_str());
    return 1;
  }
  if (poses->size() < kBlock) {
    std::fprintf(stderr, "orcart_bench_vtk: %s: holds %zu poses; at least %zu are expected\n", poses_file,
                 poses->size(), kBlock);
    return 1;
  }
  auto tree = ClusterTree::create(surface->mesh);
  auto rays = RayScene::create(surface->mesh);
  if (!tree || !rays) {
    std::fprintf(stderr, "orcart_bench_vtk: %s\n", (!tree ? tree.error() : rays.error()).message.c_str());
    return 1;
  }
  if (!pin_this_thread()) std::fprintf(stderr, "orcart_bench_vtk: not pinned; times will scatter\n");
  Bench bench{.surface = *surface, .tree = std::move(*tree), .rays = std::move(*rays)};
  std::printf("%s: %zu triangles, %zu poses\n", surface_file, surface->mesh.triangles.size(), poses->size());
  bench.form(*poses, CutoutForm::whole, bench.by_corner, "cutout, by corner", "equal counts");
  bench.form(*poses, CutoutForm::whole, bench.touching, "cutout, touching", "the cart's hold more");
  bench.form(*poses, CutoutForm::clip, bench.by_corner, "clip, by corner", "equal counts");
  bench.form(*poses, CutoutForm::clip, bench.touching, "clip, touching", "the cart's hold more");
  bench.form_ranges(*poses);
  return 0;
}

}  // namespace
}  // namespace orcart

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr,
                 "usage: orcart_bench_vtk SURFACE POSES\n"
                 "Example: orcart_bench_vtk ../shared/bench/brain_50k.ply ../shared/bench/poses200.csv\n");
    return 2;
  }
  return orcart::run(argv[1], argv[2]);
}
