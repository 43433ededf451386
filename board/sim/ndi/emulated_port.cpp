// Tool memory and life cycle of a port handle.
#include "board/sim/ndi/emulated_port.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace orcart {
namespace {

constexpr std::size_t kDefinitionBytes = 752;
constexpr std::size_t kMarkersAt = 72;

}  // namespace

void EmulatedPort::allocate() noexcept {
  release();
  allocated_ = true;
}

NdiError EmulatedPort::write(std::size_t address, std::span<const std::byte> bytes) noexcept {
  if (address + bytes.size() > kMemoryBytes) return NdiError::out_of_range;
  std::copy(bytes.begin(), bytes.end(), memory_.begin() + static_cast<std::ptrdiff_t>(address));
  occupied_ = true;
  initialised_ = enabled_ = reported_ = false;
  return NdiError::none;
}

std::uint32_t EmulatedPort::number_at(std::size_t address) const noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | byte_at(address + i);
  return value;
}

std::string_view EmulatedPort::text_at(std::size_t address, std::size_t size) const noexcept {
  const std::string_view all{reinterpret_cast<const char*>(memory_.data()) + address, size};
  return all.substr(0, all.find('\0'));
}

bool EmulatedPort::checksum_holds() const noexcept {
  std::uint32_t sum = 0;
  for (std::size_t i = 6; i < kDefinitionBytes; ++i) sum += byte_at(i);
  return text_at(0, 4) == "NDI" && (sum & 0xFFFFu) == (number_at(4) & 0xFFFFu);
}

NdiError EmulatedPort::initialise() noexcept {
  if (!occupied_) return NdiError::no_tool;
  if (!checksum_holds()) return NdiError::damaged_definition;
  const std::uint32_t count = number_at(28);
  if (count < 3 || count > kMaxToolMarkers) return NdiError::unsupported_tool;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float part = std::bit_cast<float>(number_at(kMarkersAt + 12 * i + 4 * axis));
      if (!std::isfinite(part)) return NdiError::unsupported_tool;
      markers_mm_[i][static_cast<Eigen::Index>(axis)] = static_cast<double>(part);
    }
  }
  marker_count_ = count;
  initialised_ = true;
  return NdiError::none;
}

NdiError EmulatedPort::enable(char priority) noexcept {
  if (priority != 'S' && priority != 'D' && priority != 'B') return NdiError::no_such_priority;
  if (!occupied_) return NdiError::not_initialised_port;
  if (!initialised_) {
    if (const NdiError error = initialise(); error != NdiError::none) return error;
  }
  enabled_ = reported_ = true;
  return NdiError::none;
}

NdiError EmulatedPort::disable() noexcept {
  if (!initialised_) return NdiError::not_initialised_port;
  enabled_ = reported_ = false;
  return NdiError::none;
}

std::uint32_t EmulatedPort::status() const noexcept {
  return (occupied_ ? 0x01u : 0u) | (initialised_ ? 0x10u : 0u) | (enabled_ ? 0x20u : 0u);
}

}  // namespace orcart
