// Each press is logged once; a refused one with its reason.
#include "firmware-host/app/capture_log.hpp"

#include <gtest/gtest.h>

namespace orcart::testing {
namespace {

TEST(CaptureLog, TellsOnceWhatBecameOfEachPress) {
  Ledger<CaptureRecord> captures(8);
  CaptureLog log;
  EXPECT_EQ(log.news(captures), "");
  captures.append({.unit = 1});
  captures.append({.unit = 1, .streaming = true});
  captures.append({.unit = 2, .refusal = Refusal::stamp_in_future});
  captures.append({.unit = 3, .refusal = Refusal::tool_unseen});
  EXPECT_EQ(log.news(captures),
            "capture 1 painted\n"
            "capture 2 painted nothing: frame from the future; the camera's stamps do not mean what [camera] "
            "stamp and after_exposure_ms say\n"
            "capture 3 painted nothing: tool not seen\n");
  EXPECT_EQ(log.news(captures), "");
}

}  // namespace
}  // namespace orcart::testing
