// Says of each press that painted nothing why it did not.
#pragma once

#include <cstddef>
#include <string>

#include "firmware-host/stages/frame_ledger.hpp"

namespace orcart {

class CaptureLog {
 public:
  /// A line for each capture refused since the last call; empty where none was.
  std::string news(const Ledger<CaptureRecord>& captures);

 private:
  std::size_t told_ = 0;
};

}  // namespace orcart
