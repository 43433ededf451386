// The other side of a v4l2loopback camera: what is written here, its readers see.
#pragma once

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "board/linux/file_descriptor.hpp"
#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"

namespace orcart::testing {

/// YUYV pictures of one size. One thread.
class LoopbackWriter {
 public:
  Result<void> open(const std::string& node, int width_px, int height_px) {
    file_ = FileDescriptor(::open(node.c_str(), O_WRONLY | O_CLOEXEC));
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<std::uint32_t>(width_px);
    format.fmt.pix.height = static_cast<std::uint32_t>(height_px);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.bytesperline = 2 * format.fmt.pix.width;
    format.fmt.pix.sizeimage = format.fmt.pix.bytesperline * format.fmt.pix.height;
    size_ = packed_bytes(PixelFormat::yuyv, width_px, height_px);
    if (!file_.valid() || ::ioctl(file_.get(), VIDIOC_S_FMT, &format) != 0)
      return fail(node + " takes no pictures of " + std::to_string(width_px) + "x" +
                  std::to_string(height_px) + " YUYV; a v4l2loopback camera would");
    // Until something was written its readers are told that it is busy.
    const std::vector<std::byte> black(size_, std::byte{16});
    if (!write(black.data())) return fail(node + " takes no picture");
    return {};
  }
  bool write(const std::byte* picture) {
    return ::write(file_.get(), picture, size_) == static_cast<ssize_t>(size_);
  }

 private:
  FileDescriptor file_;
  std::size_t size_ = 0;
};

}  // namespace orcart::testing
