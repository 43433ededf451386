// VTK, which medical programs show surfaces with: the painted globe in each format, rendered in memory and
// looked at.
#include <gtest/gtest.h>

#include <filesystem>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkGLTFImporter.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPNGReader.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "tests/board/sim/virtual_screen.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/paint/globe.hpp"

namespace orcart::testing {
namespace {

constexpr int kSize_px = 240;

/// A window in memory with the globe of one file.
class Shown {
 public:
  Shown(const TemporaryFolder& folder, const std::string& kind) {
    window_->SetOffScreenRendering(1);
    window_->SetMultiSamples(0);
    window_->SetSize(kSize_px, kSize_px);
    window_->AddRenderer(renderer_);
    const std::string file = (folder / ("globe." + kind)).string();
    if (kind == "glb") {
      importer_->SetFileName(file.c_str());
      importer_->SetRenderWindow(window_);
      importer_->Update();
      return;
    }
    picture_->SetFileName((folder / "globe.png").string().c_str());
    texture_->SetInputConnection(picture_->GetOutputPort());
    if (kind == "obj") {
      obj_->SetFileName(file.c_str());
      mapper_->SetInputConnection(obj_->GetOutputPort());
    } else {
      ply_->SetFileName(file.c_str());
      mapper_->SetInputConnection(ply_->GetOutputPort());
    }
    mapper_->ScalarVisibilityOff();
    actor_->SetMapper(mapper_);
    actor_->SetTexture(texture_);
    actor_->GetProperty()->LightingOff();
    renderer_->AddActor(actor_);
  }

  Agreement from(const GlobeView& view, bool gltf) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    const Eigen::Vector3d eye = gltf ? as_gltf(view.eye_mm()) : view.eye_mm(),
                          target = gltf ? as_gltf(Globe::kCentre_mm) : Globe::kCentre_mm,
                          up = gltf ? as_gltf(view.up) : view.up;
    camera->SetPosition(eye.data());
    camera->SetFocalPoint(target.data());
    camera->SetViewUp(up.data());
    camera->SetViewAngle(GlobeView::kAngle_deg);
    renderer_->ResetCameraClippingRange();
    window_->Render();
    vtkNew<vtkUnsignedCharArray> rgb;
    window_->GetPixelData(0, 0, kSize_px - 1, kSize_px - 1, 0, rgb);
    return agreement(view, kSize_px, [&](int x, int y) {
      const vtkIdType i = 3 * ((kSize_px - 1 - y) * kSize_px + x);
      return std::array<int, 3>{rgb->GetValue(i), rgb->GetValue(i + 1), rgb->GetValue(i + 2)};
    });
  }

 private:
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkGLTFImporter> importer_;
  vtkNew<vtkPNGReader> picture_;
  vtkNew<vtkTexture> texture_;
  vtkNew<vtkOBJReader> obj_;
  vtkNew<vtkPLYReader> ply_;
  vtkNew<vtkPolyDataMapper> mapper_;
  vtkNew<vtkActor> actor_;
};

class Vtk : public ::testing::TestWithParam<const char*> {};

TEST_P(Vtk, ShowsTheRightPictureAtTheRightPlace) {
  if (std::system("command -v Xvfb >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "Xvfb, without which Debian's VTK does not draw, is not installed";
  const VirtualScreen screen;
  ASSERT_TRUE(screen.runs());
  const TemporaryFolder folder;
  Globe::write(folder / "");
  Shown shown(folder, GetParam());
  for (const GlobeView& view : globe_views()) {
    const Agreement found = shown.from(view, std::string(GetParam()) == "glb");
    EXPECT_GT(found.right, 500);
    EXPECT_LE(found.wrong, found.right / 50) << "of " << found.right;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Vtk, ::testing::Values("obj", "ply", "glb"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace orcart::testing
