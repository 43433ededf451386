// Modes are set through libdrm; a flip is one prepared ioctl, so that nothing is allocated for a picture.
#include "board/linux/kms/drm_scan_out.hpp"

#include <drm_fourcc.h>
#include <gbm.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xf86drm.h>

#include <cerrno>
#include <cstring>

#include "board/linux/kms/turned_copy.hpp"

namespace orcart {
namespace {

std::uint64_t rotation_bit(Rotation rotation) {
  switch (rotation) {
    case Rotation::quarter:
      return DRM_MODE_ROTATE_90;  // counter-clockwise, against a panel turned clockwise
    case Rotation::half:
      return DRM_MODE_ROTATE_180;
    case Rotation::three_quarters:
      return DRM_MODE_ROTATE_270;
    case Rotation::none:
      break;
  }
  return DRM_MODE_ROTATE_0;
}

bool swaps_sides(Rotation rotation) {
  return rotation == Rotation::quarter || rotation == Rotation::three_quarters;
}

PortFault commit_fault(int error_number) {
  switch (error_number) {
    case EBUSY:
      return PortFault::busy;
    case EACCES:
    case EPERM:
      return PortFault::no_permission;
    case ENODEV:
    case ENOENT:
    case ENXIO:
      return PortFault::disconnected;
    default:
      return PortFault::io;
  }
}

std::string reason() {
  return std::strerror(errno);
}

}  // namespace

/// One picture's memory and its number with the card.
struct DrmScanOut::Buffer {
  int card = -1;
  std::uint32_t framebuffer = 0;
  std::uint32_t dumb = 0;
  std::byte* mapped = nullptr;
  std::size_t mapped_bytes = 0;
  std::uint32_t stride_bytes = 0;
  std::vector<std::byte> upright;  ///< what is drawn into, where the panel is turned
  gbm_bo* on_gpu = nullptr;
  int dma_buf = -1;
  std::uint64_t dma_buf_id = 0;

  ~Buffer() {
    if (framebuffer != 0) drmModeRmFB(card, framebuffer);
    if (mapped != nullptr) ::munmap(mapped, mapped_bytes);
    if (dumb != 0) drmModeDestroyDumbBuffer(card, dumb);
    if (dma_buf >= 0) ::close(dma_buf);
    if (on_gpu != nullptr) gbm_bo_destroy(on_gpu);
  }
};

Result<std::unique_ptr<DrmScanOut>> DrmScanOut::open(const PanelWish& wish) {
  auto card = take_card(wish);
  if (!card) return tl::unexpected(card.error());
  VirtualTerminal terminal;
  if (!wish.tty.empty()) {
    auto taken = VirtualTerminal::take(wish.tty);
    if (!taken) return tl::unexpected(taken.error());
    terminal = std::move(*taken);
  }
  return std::unique_ptr<DrmScanOut>(new DrmScanOut(wish, std::move(*card), std::move(terminal)));
}

DrmScanOut::DrmScanOut(const PanelWish& wish, DrmCard card, VirtualTerminal terminal)
    : wish_(wish),
      terminal_(std::move(terminal)),
      card_(std::move(card)),
      gbm_(nullptr, gbm_device_destroy),
      before_(drmModeGetCrtc(card_.descriptor.get(), card_.pipe.crtc), drmModeFreeCrtc) {
  const drmModeModeInfo& mode = card_.pipe.mode;
  const bool swap = swaps_sides(wish.rotation);
  mode_ = {.width_px = swap ? mode.vdisplay : mode.hdisplay,
           .height_px = swap ? mode.hdisplay : mode.vdisplay,
           .refresh_hz = refresh_of(mode)};
  drmModeCreatePropertyBlob(card_.descriptor.get(), &mode, sizeof mode, &mode_blob_);
}

DrmScanOut::~DrmScanOut() {
  const int card = card_.descriptor.get();
  if (before_ && before_->mode_valid != 0 && before_->buffer_id != 0) {
    std::uint32_t connector = card_.pipe.connector;
    drmModeSetCrtc(card, before_->crtc_id, before_->buffer_id, before_->x, before_->y, &connector, 1,
                   &before_->mode);
  }
  for (auto& buffer : buffers_) buffer.reset();  // removing the shown one switches the pipe off
  gbm_.reset();
  if (mode_blob_ != 0) drmModeDestroyPropertyBlob(card, mode_blob_);
  drmDropMaster(card);
}

gbm_device* DrmScanOut::gbm() noexcept {
  if (!gbm_) gbm_.reset(gbm_create_device(card_.descriptor.get()));
  return gbm_.get();
}

bool DrmScanOut::turns_by_itself() const noexcept {
  return (card_.pipe.rotations & rotation_bit(wish_.rotation)) != 0;
}

Result<void> DrmScanOut::make_mapped(Buffer& buffer) {
  const drmModeModeInfo& mode = card_.pipe.mode;
  const int card = card_.descriptor.get();
  std::uint64_t size = 0, offset = 0;
  if (drmModeCreateDumbBuffer(card, mode.hdisplay, mode.vdisplay, 32, 0, &buffer.dumb, &buffer.stride_bytes,
                              &size) != 0 ||
      drmModeMapDumbBuffer(card, buffer.dumb, &offset) != 0)
    return fail("panel " + card_.path + " gives no memory to draw into: " + reason());
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, card, static_cast<off_t>(offset));
  if (memory == MAP_FAILED) return fail("panel " + card_.path + " does not map its memory: " + reason());
  buffer.mapped = static_cast<std::byte*>(memory);
  buffer.mapped_bytes = size;
  if (wish_.rotation != Rotation::none)
    buffer.upright.resize(packed_bytes(PixelFormat::xrgb8888, mode_.width_px, mode_.height_px));
  const std::uint32_t handles[4] = {buffer.dumb}, strides[4] = {buffer.stride_bytes}, offsets[4] = {};
  if (drmModeAddFB2(card, mode.hdisplay, mode.vdisplay, DRM_FORMAT_XRGB8888, handles, strides, offsets,
                    &buffer.framebuffer, 0) != 0)
    return fail("panel " + card_.path + " shows no XRGB8888 picture: " + reason());
  return {};
}

Result<void> DrmScanOut::make_on_gpu(Buffer& buffer) {
  if (gbm() == nullptr) return fail("panel " + card_.path + " has no GBM device: " + reason());
  const auto width = static_cast<std::uint32_t>(mode_.width_px),
             height = static_cast<std::uint32_t>(mode_.height_px);
  buffer.on_gpu =
      gbm_bo_create(gbm(), width, height, GBM_FORMAT_XRGB8888, GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING);
  if (buffer.on_gpu == nullptr)
    return fail("panel " + card_.path + " gives no buffer to render into and show: " + reason());
  buffer.stride_bytes = gbm_bo_get_stride(buffer.on_gpu);
  buffer.dma_buf = gbm_bo_get_fd(buffer.on_gpu);
  buffer.dma_buf_id = new_dma_buf_id();
  if (buffer.dma_buf < 0)
    return fail("panel " + card_.path + " exports no dma-buf to render into: " + reason());
  const std::uint32_t handles[4] = {gbm_bo_get_handle(buffer.on_gpu).u32}, strides[4] = {buffer.stride_bytes},
                      offsets[4] = {gbm_bo_get_offset(buffer.on_gpu, 0)};
  const std::uint64_t modifier = gbm_bo_get_modifier(buffer.on_gpu), modifiers[4] = {modifier};
  if (modifier != DRM_FORMAT_MOD_INVALID &&
      drmModeAddFB2WithModifiers(card_.descriptor.get(), width, height, DRM_FORMAT_XRGB8888, handles, strides,
                                 offsets, modifiers, &buffer.framebuffer, DRM_MODE_FB_MODIFIERS) == 0)
    return {};
  if (drmModeAddFB2(card_.descriptor.get(), width, height, DRM_FORMAT_XRGB8888, handles, strides, offsets,
                    &buffer.framebuffer, 0) != 0)
    return fail("panel " + card_.path + " does not show what was rendered: " + reason());
  return {};
}

Result<void> DrmScanOut::make_buffers(PanelBuffers kind) {
  if (kind == PanelBuffers::gpu && !turns_by_itself())
    return fail(
        "panel " + card_.path +
        " cannot turn a rendered picture; rotation_deg = 0 or buffers = \"mapped\" would be accepted");
  kind_ = kind;
  for (auto& buffer : buffers_) {
    buffer = std::make_unique<Buffer>();
    buffer->card = card_.descriptor.get();
    auto made = kind == PanelBuffers::gpu ? make_on_gpu(*buffer) : make_mapped(*buffer);
    if (!made) {
      for (auto& each : buffers_) each.reset();
      return made;
    }
  }
  if (const int answer = commit_mode(0, DRM_MODE_ATOMIC_TEST_ONLY | DRM_MODE_ATOMIC_ALLOW_MODESET);
      answer < 0)
    return fail("panel " + card_.path + " refuses " + std::string(card_.pipe.mode.name) +
                " with its buffers: " + std::strerror(-answer) + "; another mode of its list may do");
  return {};
}

int DrmScanOut::commit_mode(int index, std::uint32_t flags) noexcept {
  const DrmPipe& pipe = card_.pipe;
  const std::unique_ptr<drmModeAtomicReq, void (*)(drmModeAtomicReq*)> request(drmModeAtomicAlloc(),
                                                                               drmModeAtomicFree);
  if (!request) return -ENOMEM;
  const auto set = [&](std::uint32_t object, std::uint32_t property, std::uint64_t value) {
    if (property != 0) drmModeAtomicAddProperty(request.get(), object, property, value);
  };
  const bool turned_by_card = kind_ == PanelBuffers::gpu && wish_.rotation != Rotation::none;
  const std::uint64_t width =
      turned_by_card ? static_cast<std::uint64_t>(mode_.width_px) : pipe.mode.hdisplay;
  const std::uint64_t height =
      turned_by_card ? static_cast<std::uint64_t>(mode_.height_px) : pipe.mode.vdisplay;
  set(pipe.connector, pipe.connector_crtc, pipe.crtc);
  set(pipe.crtc, pipe.crtc_mode, mode_blob_);
  set(pipe.crtc, pipe.crtc_active, 1);
  set(pipe.plane, pipe.plane_fb, buffers_[static_cast<std::size_t>(index)]->framebuffer);
  set(pipe.plane, pipe.plane_crtc, pipe.crtc);
  set(pipe.plane, pipe.src_x, 0);
  set(pipe.plane, pipe.src_y, 0);
  set(pipe.plane, pipe.src_w, width << 16);
  set(pipe.plane, pipe.src_h, height << 16);
  set(pipe.plane, pipe.crtc_x, 0);
  set(pipe.plane, pipe.crtc_y, 0);
  set(pipe.plane, pipe.crtc_w, pipe.mode.hdisplay);
  set(pipe.plane, pipe.crtc_h, pipe.mode.vdisplay);
  set(pipe.plane, pipe.plane_rotation, rotation_bit(turned_by_card ? wish_.rotation : Rotation::none));
  return drmModeAtomicCommit(card_.descriptor.get(), request.get(), flags, nullptr);
}

ImageDescriptor DrmScanOut::buffer(int index) noexcept {
  Buffer& b = *buffers_[static_cast<std::size_t>(index)];
  ImageDescriptor image = packed_image(b.upright.empty() ? b.mapped : b.upright.data(), PixelFormat::xrgb8888,
                                       mode_.width_px, mode_.height_px);
  if (b.upright.empty()) image.planes[0].stride_bytes = b.stride_bytes;
  image.planes[0].dma_buf_fd = b.dma_buf;
  image.planes[0].dma_buf_id = b.dma_buf_id;
  if (b.on_gpu != nullptr) image.modifier = gbm_bo_get_modifier(b.on_gpu);
  return image;
}

void DrmScanOut::finish_drawing(int index) noexcept {
  Buffer& b = *buffers_[static_cast<std::size_t>(index)];
  if (b.upright.empty()) return;
  ImageDescriptor panel =
      packed_image(b.mapped, PixelFormat::xrgb8888, card_.pipe.mode.hdisplay, card_.pipe.mode.vdisplay);
  panel.planes[0].stride_bytes = b.stride_bytes;
  copy_turned(buffer(index), panel, wish_.rotation);
}

Result<void, PortFault> DrmScanOut::flip(int index, std::uint64_t serial) noexcept {
  std::uint32_t object = card_.pipe.plane, count = 1, property = card_.pipe.plane_fb;
  std::uint64_t value = buffers_[static_cast<std::size_t>(index)]->framebuffer;
  drm_mode_atomic commit{.flags = DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT,
                         .count_objs = 1,
                         .objs_ptr = reinterpret_cast<std::uint64_t>(&object),
                         .count_props_ptr = reinterpret_cast<std::uint64_t>(&count),
                         .props_ptr = reinterpret_cast<std::uint64_t>(&property),
                         .prop_values_ptr = reinterpret_cast<std::uint64_t>(&value),
                         .reserved = 0,
                         .user_data = serial};
  if (drmIoctl(card_.descriptor.get(), DRM_IOCTL_MODE_ATOMIC, &commit) == 0) return {};
  return tl::unexpected(commit_fault(errno));
}

std::optional<FlipEvent> DrmScanOut::next_flip() noexcept {
  for (int i = 0; i < 8; ++i) {  // more events than buffers there cannot be
    if (unread_.empty()) {
      const ssize_t size = ::read(card_.descriptor.get(), events_.data(), events_.size());
      if (size <= 0) return std::nullopt;
      unread_ = std::span(events_).first(static_cast<std::size_t>(size));
    }
    if (auto flip = take_flip_event(unread_)) return flip;
  }
  return std::nullopt;
}

Result<void, PortFault> DrmScanOut::set_mode(int index) noexcept {
  const int answer = commit_mode(index, DRM_MODE_ATOMIC_ALLOW_MODESET);
  if (answer < 0) return tl::unexpected(commit_fault(-answer));
  return {};
}

std::optional<Instant> DrmScanOut::newest_vblank() noexcept {
  std::uint64_t count = 0, at_ns = 0;
  if (drmCrtcGetSequence(card_.descriptor.get(), card_.pipe.crtc, &count, &at_ns) != 0 || at_ns == 0)
    return std::nullopt;
  return instant_from_nanos(static_cast<std::int64_t>(at_ns));
}

// With room for one mode the kernel tells what it knows; without any it would probe the panel, which takes
// long.
bool DrmScanOut::connected() noexcept {
  drm_mode_modeinfo room{};
  drm_mode_get_connector ask{};
  ask.connector_id = card_.pipe.connector;
  ask.count_modes = 1;
  ask.modes_ptr = reinterpret_cast<std::uint64_t>(&room);
  if (drmIoctl(card_.descriptor.get(), DRM_IOCTL_MODE_GETCONNECTOR, &ask) != 0) return false;
  return ask.connection == DRM_MODE_CONNECTED;
}

}  // namespace orcart
