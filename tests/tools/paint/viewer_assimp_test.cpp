// assimp, by which many programs read models: each triangle of the painted globe has the colour of its place.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include "firmware-host/files/picture_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/paint/globe.hpp"

namespace orcart::testing {
namespace {

class AssimpReads : public ::testing::TestWithParam<const char*> {};

/// The picture that the first material of a scene names or holds.
Picture picture_of(const aiScene& scene, const TemporaryFolder& folder) {
  aiString name;
  const aiMaterial& material = *scene.mMaterials[scene.mMeshes[0]->mMaterialIndex];
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS &&
      material.GetTexture(aiTextureType_BASE_COLOR, 0, &name) != aiReturn_SUCCESS) {
    ADD_FAILURE() << "the material names no picture";
    return {};
  }
  std::filesystem::path file = folder / name.C_Str();
  if (const aiTexture* held = scene.GetEmbeddedTexture(name.C_Str())) {
    EXPECT_EQ(held->mHeight, 0U) << "a compressed picture";
    file = folder.write("held.png", std::string(reinterpret_cast<const char*>(held->pcData), held->mWidth));
  }
  auto picture = read_picture(file);
  EXPECT_TRUE(picture) << picture.error().message;
  return picture ? *picture : Picture{};
}

Eigen::Vector3d vector_of(const aiVector3D& v) {
  return {double(v.x), double(v.y), double(v.z)};
}

TEST_P(AssimpReads, FindsTheColourOfEachTriangleAtItsPlace) {
  const TemporaryFolder folder;
  Globe::write(folder / "");
  const std::string kind = GetParam();
  ::Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile((folder / ("globe." + kind)).string(), aiProcess_PreTransformVertices);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1U);
  const aiMesh& mesh = *scene->mMeshes[0];
  ASSERT_TRUE(mesh.HasTextureCoords(0));
  const Picture picture = picture_of(*scene, folder);
  ASSERT_GT(picture.width_px, 0);
  const Eigen::Vector3d centre = kind == "glb" ? as_gltf(Globe::kCentre_mm) : Globe::kCentre_mm;
  int right = 0, wrong = 0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero(), uv = Eigen::Vector3d::Zero();
    for (unsigned c = 0; c < 3; ++c) {
      const unsigned vertex = mesh.mFaces[f].mIndices[c];
      middle += vector_of(mesh.mVertices[vertex]) / 3;
      uv += vector_of(mesh.mTextureCoords[0][vertex]) / 3;
    }
    const Eigen::Vector3d out = middle - centre;
    const Eigen::Vector3d direction = kind == "glb" ? Eigen::Vector3d(out.x(), -out.z(), out.y()) : out;
    EXPECT_NEAR(direction.norm(), (kind == "glb" ? 0.001 : 1) * Globe::kRadius_mm,
                (kind == "glb" ? 0.001 : 1) * 0.5);
    if (!Globe::is_plain(direction)) continue;
    const int x = std::clamp(static_cast<int>(uv.x() * picture.width_px), 0, picture.width_px - 1),
              y = std::clamp(static_cast<int>((1 - uv.y()) * picture.height_px), 0, picture.height_px - 1);
    const auto* rgb = &picture.rgba[4 * static_cast<std::size_t>(y * picture.width_px + x)];
    ++(Globe::bright_in({rgb[0], rgb[1], rgb[2]}) == Globe::side_of(direction) ? right : wrong);
  }
  EXPECT_GT(right, 800);
  EXPECT_EQ(wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, AssimpReads, ::testing::Values("obj", "ply", "glb"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace orcart::testing
