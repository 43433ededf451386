// Small volumes written as MetaImage, for the tests of region growing: a dark ball in bright tissue.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/volume/volume_reader.hpp"

namespace orcart {

struct SampleVolume {
  std::array<int, 3> size{40, 40, 40};
  std::array<double, 3> spacing_mm{1, 1, 1};
  std::string direction = "1 0 0 0 1 0 0 0 1";  ///< MetaImage's TransformMatrix: where i, j and k run, LPS
  std::string offset = "0 0 0";
  std::function<int(int i, int j, int k)> intensity;

  std::filesystem::path write(const TemporaryFolder& folder, const std::string& name = "volume.mha") const {
    std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n";
    text += "TransformMatrix = " + direction + "\nOffset = " + offset + "\nElementSpacing =";
    for (const double step : spacing_mm) text += " " + std::to_string(step);
    text += "\nDimSize =";
    for (const int count : size) text += " " + std::to_string(count);
    text += "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
    for (int k = 0; k < size[2]; ++k)
      for (int j = 0; j < size[1]; ++j)
        for (int i = 0; i < size[0]; ++i) text += static_cast<char>(intensity(i, j, k));
    return folder.write(name, text);
  }
};

/// 20 within `radius` voxels (in units of the first axis' spacing) of the voxel (20, 20, 20), 100 elsewhere.
inline SampleVolume dark_ball(double radius) {
  SampleVolume volume;
  volume.intensity = [radius](int i, int j, int k) {
    const int x = i - 20, y = j - 20, z = k - 20;
    return x * x + y * y + z * z <= radius * radius ? 20 : 100;
  };
  return volume;
}

/// The same, as read.
inline Volume read_sample(const TemporaryFolder& folder, const SampleVolume& sample) {
  auto volume = read_volume({.path = sample.write(folder)});
  return volume ? *std::move(volume) : Volume{};
}

}  // namespace orcart
