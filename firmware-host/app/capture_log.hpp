// Says what became of each press: painted, or why not.
#pragma once

#include <cstddef>
#include <string>

#include "firmware-host/stages/frame_ledger.hpp"

namespace orcart {

class CaptureLog {
 public:
  /// A line for each capture painted or refused since the last call, but for a stream's pictures.
  std::string news(const Ledger<CaptureRecord>& captures);

 private:
  std::size_t told_ = 0;
};

}  // namespace orcart
