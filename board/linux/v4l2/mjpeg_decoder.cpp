// libjpeg reports errors by a jump, which must not cross a destructor: the functions it may leave hold none.
#include "board/linux/v4l2/mjpeg_decoder.hpp"

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

#include <jerror.h>

namespace orcart {
namespace {

/// Room for libjpeg's buffers of a single scan: a few rows, a few tables. Measured: 0.15 MB at 1920x1080.
constexpr std::size_t arena_bytes(int width_px) {
  return 512U * 1024U + static_cast<std::size_t>(width_px) * 512U;
}

/// Hands out aligned pieces and forgets them all at once.
class Arena {
 public:
  explicit Arena(std::size_t bytes) : bytes_(bytes) {}
  void* take(std::size_t bytes) noexcept {
    const std::size_t begin = (used_ + kAlign - 1) / kAlign * kAlign;
    if (bytes > bytes_.size() || begin > bytes_.size() - bytes) return nullptr;
    used_ = begin + bytes;
    return bytes_.data() + begin;
  }
  void forget() noexcept { used_ = 0; }

 private:
  static constexpr std::size_t kAlign = 64;  // what SIMD code asks for
  std::vector<std::byte> bytes_;
  std::size_t used_ = 0;
};

}  // namespace

struct MjpegDecoder::State {
  jpeg_decompress_struct jpeg{};  // first: libjpeg's callbacks find the State by it
  jpeg_error_mgr errors{};
  std::jmp_buf leave{};
  int width_px, height_px;
  Arena arena;
  jpeg_memory_mgr own{};  ///< libjpeg's own manager, for what lives as long as the decoder

  State(int width, int height) : width_px(width), height_px(height), arena(arena_bytes(width)) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { jpeg_destroy_decompress(&jpeg); }
};

namespace {

/// A grey picture in JPEG, with all four standard tables.
std::vector<std::byte> grey_picture(int width_px, int height_px) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width_px);
  jpeg.image_height = static_cast<JDIMENSION>(height_px);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row(static_cast<std::size_t>(width_px) * 3, 128);
  JSAMPLE* pixels = row.data();
  while (jpeg.next_scanline < jpeg.image_height) (void)jpeg_write_scanlines(&jpeg, &pixels, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const auto* begin = reinterpret_cast<const std::byte*>(bytes);
  std::vector<std::byte> picture(begin, begin + size);
  std::free(bytes);  // jpeg_mem_dest takes it from malloc
  return picture;
}

MjpegDecoder::State& state_of(j_common_ptr jpeg) {
  return *static_cast<MjpegDecoder::State*>(jpeg->client_data);
}

[[noreturn]] void leave(j_common_ptr jpeg) {
  std::longjmp(state_of(jpeg).leave, 1);
}

void say_nothing(j_common_ptr) {}

/// A negative level is a warning. Bytes that are skipped before a marker spoil nothing, and many USB cameras
/// pad with a few of them in every frame; every other warning is of pixels that are not the camera's.
void count_damage(j_common_ptr jpeg, int level) {
  if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA) ++jpeg->err->num_warnings;
}

void* take(j_common_ptr jpeg, int pool, std::size_t bytes) {
  MjpegDecoder::State& state = state_of(jpeg);
  if (pool == JPOOL_PERMANENT) return state.own.alloc_small(jpeg, pool, bytes);
  void* piece = state.arena.take(bytes);
  if (piece == nullptr) leave(jpeg);
  return piece;
}

JSAMPARRAY take_rows(j_common_ptr jpeg, int pool, JDIMENSION width, JDIMENSION rows) {
  auto** const array = static_cast<JSAMPARRAY>(take(jpeg, pool, rows * sizeof(JSAMPROW)));
  const std::size_t stride = (std::size_t{width} + 63) / 64 * 64;  // SIMD code writes past the row's end
  auto* const pixels = static_cast<JSAMPLE*>(take(jpeg, pool, stride * rows));
  for (JDIMENSION r = 0; r < rows; ++r) array[r] = pixels + r * stride;
  return array;
}

JBLOCKARRAY refuse_blocks(j_common_ptr jpeg, int, JDIMENSION, JDIMENSION) {
  leave(jpeg);  // whole pictures of coefficients: progressive, which no camera sends
}
jvirt_barray_ptr refuse_virtual_blocks(j_common_ptr jpeg, int, boolean, JDIMENSION, JDIMENSION, JDIMENSION) {
  leave(jpeg);
}
jvirt_sarray_ptr refuse_virtual_rows(j_common_ptr jpeg, int, boolean, JDIMENSION, JDIMENSION, JDIMENSION) {
  leave(jpeg);
}

void forget(j_common_ptr jpeg, int pool) {
  MjpegDecoder::State& state = state_of(jpeg);
  if (pool == JPOOL_IMAGE) return state.arena.forget();
  state.own.free_pool(jpeg, pool);
}

/// Everything that libjpeg may leave by a jump; plain values only.
bool decode_rows(MjpegDecoder::State& state, std::span<const std::byte> bytes, const ImageDescriptor& into) {
  if (setjmp(state.leave) != 0) return false;
  jpeg_mem_src(&state.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  if (jpeg_read_header(&state.jpeg, TRUE) != JPEG_HEADER_OK) return false;
  if (state.jpeg.image_width != static_cast<JDIMENSION>(state.width_px) ||
      state.jpeg.image_height != static_cast<JDIMENSION>(state.height_px))
    return false;
  state.jpeg.out_color_space = JCS_EXT_RGBA;
  state.jpeg.dct_method = JDCT_ISLOW;
  state.jpeg.do_fancy_upsampling = TRUE;
  if (jpeg_start_decompress(&state.jpeg) == FALSE) return false;
  while (state.jpeg.output_scanline < state.jpeg.output_height) {  // bound: the picture's height
    auto* row =
        reinterpret_cast<JSAMPLE*>(into.planes[0].data + into.planes[0].offset_bytes +
                                   std::size_t{state.jpeg.output_scanline} * into.planes[0].stride_bytes);
    if (jpeg_read_scanlines(&state.jpeg, &row, 1) != 1) return false;
    if (state.errors.num_warnings != 0) return false;  // cut off or garbled: the rest would be grey
  }
  return jpeg_finish_decompress(&state.jpeg) == TRUE && state.errors.num_warnings == 0;
}

}  // namespace

Result<MjpegDecoder> MjpegDecoder::create(int width_px, int height_px) {
  if (width_px < 1 || height_px < 1 || width_px > 8192 || height_px > 8192) {
    return fail("motion JPEG of " + std::to_string(width_px) + "x" + std::to_string(height_px) +
                " cannot be decoded; 1x1 to 8192x8192 would be accepted");
  }
  auto state = std::make_unique<State>(width_px, height_px);
  jpeg_decompress_struct& jpeg = state->jpeg;
  jpeg.err = jpeg_std_error(&state->errors);
  state->errors.error_exit = leave;
  state->errors.emit_message = count_damage;
  state->errors.output_message = say_nothing;
  if (setjmp(state->leave) != 0) return fail("libjpeg cannot start");
  jpeg_create_decompress(&jpeg);
  jpeg.client_data = state.get();
  state->own = *jpeg.mem;
  jpeg.mem->alloc_small = take;
  jpeg.mem->alloc_large = take;
  jpeg.mem->alloc_sarray = take_rows;
  jpeg.mem->alloc_barray = refuse_blocks;
  jpeg.mem->request_virt_sarray = refuse_virtual_rows;
  jpeg.mem->request_virt_barray = refuse_virtual_blocks;
  jpeg.mem->free_pool = forget;
  MjpegDecoder decoder(std::move(state));
  // libjpeg takes its tables' memory when it first meets them: that is now.
  std::vector<std::byte> pixels(packed_bytes(PixelFormat::rgba8888, width_px, height_px));
  if (!decoder.decode(grey_picture(width_px, height_px),
                      packed_image(pixels.data(), PixelFormat::rgba8888, width_px, height_px)))
    return fail("libjpeg cannot decode its own picture");
  return decoder;
}

MjpegDecoder::MjpegDecoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
MjpegDecoder::MjpegDecoder(MjpegDecoder&&) noexcept = default;
MjpegDecoder& MjpegDecoder::operator=(MjpegDecoder&&) noexcept = default;
MjpegDecoder::~MjpegDecoder() = default;

Result<void, PortFault> MjpegDecoder::decode(std::span<const std::byte> jpeg,
                                             const ImageDescriptor& into) noexcept {
  const bool fits = into.format == PixelFormat::rgba8888 && into.width_px == state_->width_px &&
                    into.height_px == state_->height_px && into.planes[0].data != nullptr;
  if (!fits) return tl::unexpected(PortFault::unsupported);
  state_->errors.num_warnings = 0;
  const bool whole = !jpeg.empty() && decode_rows(*state_, jpeg, into);
  jpeg_abort_decompress(&state_->jpeg);
  if (!whole) return tl::unexpected(PortFault::damaged);
  return {};
}

}  // namespace orcart
