// What is lent stays mapped until it is given back, whatever becomes of the device.
#include "board/linux/v4l2/v4l2_frame_source.hpp"

#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>

namespace orcart {
namespace {

constexpr std::uint32_t kWireBuffers = 4;  // of compressed frames: each goes back once it is decoded

CameraTrouble no_buffers(const CameraWish& wish, PortFault fault) {
  return {fault, "camera " + wish.device + " gives no buffers to stream into: " +
                     std::string(fault == PortFault::busy ? "another program streams from it; end that one"
                                                          : word_for(fault))};
}

}  // namespace

Result<std::unique_ptr<V4l2FrameSource>> V4l2FrameSource::open(const Setup& setup) {
  std::unique_ptr<V4l2FrameSource> source(new V4l2FrameSource(setup));
  const CameraWish& wish = setup.wish;
  source->format_ = {.width_px = wish.width_px,
                     .height_px = wish.height_px,
                     .format = picture_format(wish.format),
                     .rate_hz = wish.rate_hz};
  if (source->decodes()) {
    if (wish.field != FieldChoice::progressive)
      return fail("camera " + wish.device +
                  ": mjpeg has no fields; field = \"progressive\" would be accepted");
    auto decoder = MjpegDecoder::create(wish.width_px, wish.height_px);
    if (!decoder) return tl::unexpected(decoder.error());
    source->decoder_.emplace(std::move(*decoder));
    source->pool_.resize(packed_bytes(PixelFormat::rgba8888, wish.width_px, wish.height_px) * setup.buffers);
    source->slots_.resize(setup.buffers);
  }
  if (auto opened = source->open_device(); !opened) return fail(opened.error().sentence);
  return source;
}

V4l2FrameSource::~V4l2FrameSource() {
  stop();
}

Result<void, CameraTrouble> V4l2FrameSource::open_device() noexcept {
  auto node = open_camera_node(setup_.calls, setup_.wish.device);
  if (!node) return tl::unexpected(node.error());
  const CameraOffer offer = offer_of(*node);
  if (auto fits = check(setup_.wish, offer); !fits)
    return tl::unexpected(CameraTrouble{PortFault::unsupported, fits.error().message});
  auto agreed = agree(*node, setup_.wish);
  if (!agreed) return tl::unexpected(agreed.error());
  if (auto set = set_controls(*node, setup_.wish); !set) return set;
  auto buffers = request_buffers(*node, decodes() ? kWireBuffers : setup_.buffers, agreed->image_bytes);
  if (!buffers) return tl::unexpected(no_buffers(setup_.wish, buffers.error()));
  watch_for_changes(*node);
  card_ = offer.card;
  agreed_ = *agreed;
  format_.rate_hz = agreed->rate_hz;
  monotonic_stamps_ = buffers->monotonic_stamps;
  device_ = std::move(*node);
  return adopt(std::move(*buffers));
}

Result<void, CameraTrouble> V4l2FrameSource::adopt(KernelBuffers&& buffers) noexcept {
  if (decodes()) {
    wire_ = std::move(buffers.mappings);
    return {};
  }
  if (slots_.empty()) slots_.resize(buffers.mappings.size());
  if (buffers.mappings.size() < slots_.size())
    return tl::unexpected(no_buffers(setup_.wish, PortFault::unsupported));
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    (slot.place == Place::lent ? slot.next : slot.memory) = std::move(buffers.mappings[i]);
  }
  return {};
}

Result<void, PortFault> V4l2FrameSource::start() noexcept {
  if (streaming_) return tl::unexpected(PortFault::busy);
  if (fault_ || !device_.valid()) return recover();
  return start_stream();
}

Result<void, PortFault> V4l2FrameSource::start_stream() noexcept {
  queued_ = 0;
  const std::size_t count = decodes() ? wire_.size() : slots_.size();
  for (std::size_t i = 0; i < count; ++i)
    if (decodes() || slots_[i].place == Place::home) queue(static_cast<std::uint32_t>(i));
  if (auto on = set_streaming(device_, Streaming::on); !on) {
    end_stream();
    fault_ = on.error();
    return on;
  }
  streaming_ = true;
  silent_at_ = setup_.clock.now() + kFirstFrame;
  return {};
}

void V4l2FrameSource::end_stream() noexcept {
  if (device_.valid()) (void)set_streaming(device_, Streaming::off);
  streaming_ = poll_failed_ = false;
  queued_ = 0;
  for (Slot& slot : slots_)
    if (slot.place == Place::queued) slot.place = Place::home;
}

void V4l2FrameSource::stop() noexcept {
  end_stream();
  for (Slot& slot : slots_) {
    slot.place = Place::home;
    if (slot.next.valid()) slot.memory = std::move(slot.next);
  }
}

Result<void, PortFault> V4l2FrameSource::recover() noexcept {
  end_stream();
  if (device_.valid()) release_buffers(device_);
  device_.reset();
  wire_.clear();
  for (Slot& slot : slots_) {
    slot.next = {};
    if (slot.place != Place::lent) slot.memory = {};
  }
  if (auto opened = open_device(); !opened) {
    device_.reset();
    trouble_ = opened.error().sentence;
    return tl::unexpected(*(fault_ = opened.error().fault));
  }
  trouble_.clear();
  fault_.reset();
  return start_stream();
}

// A driver without a queued buffer reports an error instead of sleeping: then only time can bring something.
void V4l2FrameSource::wait(Instant deadline) noexcept {
  if (!streaming_ || fault_ || queued_ == 0) return setup_.clock.sleep_until(deadline);
  const int events = setup_.calls.wait(device_.fd(), POLLIN | POLLPRI, deadline);
  if ((events & POLLPRI) != 0 && signal_changed(device_)) fault_ = PortFault::io;
  poll_failed_ = (events & (POLLERR | POLLHUP | POLLNVAL)) != 0;
}

tl::unexpected<PortFault> V4l2FrameSource::fail_with(PortFault fault) noexcept {
  fault_ = fault;
  return tl::unexpected(fault);
}

Result<FrameBuffer, PortFault> V4l2FrameSource::take() noexcept {
  if (fault_) return tl::unexpected(*fault_);
  if (!streaming_) return tl::unexpected(PortFault::nothing_yet);
  for (std::size_t i = 0; i <= slots_.size(); ++i) {
    const auto filled = dequeue_buffer(device_);
    if (!filled && filled.error() != PortFault::nothing_yet) return fail_with(filled.error());
    if (!filled) break;
    silent_at_ = setup_.clock.now() + std::max<Nanos>(kSilence, 6 * period_of(format_.rate_hz));
    poll_failed_ = false;
    if (filled->index >= (decodes() ? wire_.size() : slots_.size())) return fail_with(PortFault::io);
    if (!was_queued(filled->index)) return tl::unexpected(PortFault::damaged);
    --queued_;
    const bool bad = filled->damaged || (!decodes() && filled->bytes < agreed_.image_bytes);
    if (!bad && !is_other_field(*filled)) return decodes() ? decode(*filled) : accept(*filled);
    if (!decodes()) slots_[filled->index].place = Place::home;
    queue(filled->index);
    if (bad) return tl::unexpected(PortFault::damaged);
  }
  if (poll_failed_ && queued_ > 0) return fail_with(PortFault::io);
  if (queued_ == 0) silent_at_ = setup_.clock.now() + kSilence;  // ours to give, not the driver's fault
  if (setup_.clock.now() > silent_at_) return fail_with(PortFault::timed_out);
  return tl::unexpected(PortFault::nothing_yet);
}

// v4l2loopback fills and hands out any buffer, whoever holds it. A second loan would be of memory that goes
// home with the first.
bool V4l2FrameSource::was_queued(std::uint32_t index) const noexcept {
  return queued_ > 0 && (decodes() || slots_[index].place == Place::queued);
}

bool V4l2FrameSource::is_other_field(const FilledBuffer& filled) const noexcept {
  if (agreed_.layout != FieldLayout::one_at_a_time) return false;
  return (filled.field == V4L2_FIELD_TOP) != (setup_.wish.field == FieldChoice::top);
}

ImageDescriptor V4l2FrameSource::picture_in(const BufferMapping& memory) const noexcept {
  ImageDescriptor whole = packed_image(memory.data(), format_.format, static_cast<int>(agreed_.wire_width_px),
                                       static_cast<int>(agreed_.wire_height_px));
  for (int p = 0; p < whole.plane_count; ++p) {
    ImagePlane& plane = whole.planes[static_cast<std::size_t>(p)];
    plane.dma_buf_fd = memory.dma_buf_fd();
    plane.dma_buf_id = memory.dma_buf_id();
    if (agreed_.stride_bytes != 0) plane.stride_bytes = agreed_.stride_bytes;
  }
  if (format_.format == PixelFormat::nv12)
    whole.planes[1].offset_bytes = whole.planes[0].stride_bytes * agreed_.wire_height_px;
  return field_of(whole, agreed_.layout, setup_.wish.field);
}

Result<FrameBuffer, PortFault> V4l2FrameSource::accept(const FilledBuffer& filled) noexcept {
  Slot& slot = slots_[filled.index];
  slot.place = Place::lent;
  const StampedAt stamped = filled.stamped_at_start ? StampedAt::start_of_exposure : StampedAt::end_of_frame;
  return FrameBuffer{.index = filled.index,
                     .image = picture_in(slot.memory),
                     .sequence = filled.sequence,
                     .stamp = filled.stamp + field_delay(agreed_.layout, setup_.wish.field, stamped,
                                                         period_of(format_.rate_hz))};
}

std::size_t V4l2FrameSource::free_picture() const noexcept {
  std::size_t i = 0;
  while (i < slots_.size() && slots_[i].place != Place::home) ++i;
  return i;
}

// Without a free picture the frame is lost, as a driver without a free buffer loses it: the sequence tells.
Result<FrameBuffer, PortFault> V4l2FrameSource::decode(const FilledBuffer& filled) noexcept {
  const std::size_t picture = free_picture();
  if (picture == slots_.size()) {
    queue(filled.index);
    return tl::unexpected(PortFault::nothing_yet);
  }
  const std::size_t size = packed_bytes(PixelFormat::rgba8888, format_.width_px, format_.height_px);
  const ImageDescriptor image =
      packed_image(pool_.data() + picture * size, PixelFormat::rgba8888, format_.width_px, format_.height_px);
  const BufferMapping& wire = wire_[filled.index];
  const std::size_t bytes = std::min<std::size_t>(filled.bytes, wire.size());
  const auto decoded = decoder_->decode({wire.data(), bytes}, image);
  queue(filled.index);
  if (!decoded) return tl::unexpected(PortFault::damaged);
  slots_[picture].place = Place::lent;
  return FrameBuffer{.index = static_cast<std::uint32_t>(picture),
                     .image = image,
                     .sequence = filled.sequence,
                     .stamp = filled.stamp};
}

void V4l2FrameSource::queue(std::uint32_t index) noexcept {
  if (const auto queued = queue_buffer(device_, index); !queued) {
    if (streaming_) fault_ = queued.error();
    return;
  }
  ++queued_;
  if (!decodes()) slots_[index].place = Place::queued;
}

void V4l2FrameSource::give_back(std::uint32_t index) noexcept {
  if (index >= slots_.size() || slots_[index].place != Place::lent) return;
  Slot& slot = slots_[index];
  slot.place = Place::home;
  if (decodes()) return;
  if (slot.next.valid()) slot.memory = std::move(slot.next);
  if (streaming_ && !fault_ && slot.memory.valid()) queue(index);
}

bool V4l2FrameSource::exports_dma_bufs() const noexcept {
  return std::ranges::all_of(slots_, [](const Slot& s) { return s.memory.dma_buf_fd() >= 0; });
}

}  // namespace orcart
