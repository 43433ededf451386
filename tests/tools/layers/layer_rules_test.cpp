// Seeded bad lines: each rule of the layer check is shown to bite, and to leave good lines alone.
#include "tests/tools/layers/layer_rules.hpp"

#include <gtest/gtest.h>

namespace orcart::layers {
namespace {

/// The lines found in a file whose first line is in order and whose later lines are `body`.
std::vector<int> lines_found(const std::string& path, const std::string& body) {
  std::vector<int> lines;
  for (const Finding& finding : check({path, "// What this file is for.\n" + body}))
    lines.push_back(finding.line);
  return lines;
}

using Lines = std::vector<int>;

TEST(LayerRules, RefuseAnIncludeThatPointsUp) {
  EXPECT_EQ(lines_found("realtime/base/a.hpp", "#include \"realtime/kernel/clock.hpp\"\n"), Lines{2});
  EXPECT_EQ(lines_found("realtime/mapper/a.cpp", "\n# include <render/atlas/atlas.hpp>\n"), Lines{3});
  EXPECT_EQ(lines_found("render/atlas/a.cpp", "#include \"board/ports/panel.hpp\"\n"), Lines{2});
  EXPECT_EQ(lines_found("board/linux/a.cpp", "#include \"render/egl/context.hpp\"\n"), Lines{2});
  EXPECT_EQ(lines_found("board/linux/a.cpp", "#include \"board/sim/tool_motion.hpp\"\n"), Lines{2});
  EXPECT_EQ(lines_found("firmware-host/stages/a.cpp", "#include \"board/sim/tool_motion.hpp\"\n"), Lines{2});
  EXPECT_EQ(lines_found("firmware-host/app/a.cpp", "#include \"tools/paint/paint.hpp\"\n"), Lines{2});
  EXPECT_EQ(lines_found("tools/paint/a.cpp", "#include \"tests/support/world.hpp\"\n"), Lines{2});
}

TEST(LayerRules, AllowTheEdgesOfTheDesign) {
  EXPECT_TRUE(may_include("realtime/kernel", "realtime/base"));
  EXPECT_TRUE(may_include("realtime/mapper", "realtime/optics"));
  EXPECT_TRUE(may_include("board/ports", "realtime/kernel"));
  EXPECT_TRUE(may_include("board/sim", "board/ports"));
  EXPECT_TRUE(may_include("render/views", "render/atlas"));
  EXPECT_TRUE(may_include("firmware-host/stages", "board/ports"));
  EXPECT_TRUE(may_include("firmware-host/app", "board/linux"));
  EXPECT_TRUE(may_include("tools/paint", "firmware-host/files"));
  EXPECT_TRUE(may_include("tests/realtime/base", "tools/paint"));
}

TEST(LayerRules, KnowNoSidewaysEdgeInsideRealtime) {
  EXPECT_FALSE(may_include("realtime/kernel", "realtime/geometry"));
  EXPECT_FALSE(may_include("realtime/optics", "realtime/registration"));
  EXPECT_FALSE(may_include("realtime/sync", "realtime/mapper"));
}

TEST(LayerRules, RefuseAFolderThatIsInNoTable) {
  EXPECT_FALSE(may_include("realtime/new", "realtime/base"));
}

TEST(LayerRules, FenceDeviceHeaders) {
  for (const std::string header :
       {"libusb-1.0/libusb.h", "gpiod.h", "linux/videodev2.h", "xf86drmMode.h", "gbm.h"}) {
    EXPECT_EQ(lines_found("firmware-host/camera/a.cpp", "#include <" + header + ">\n"), Lines{2}) << header;
    EXPECT_EQ(lines_found("board/linux/a.cpp", "#include <" + header + ">\n"), Lines{}) << header;
  }
}

TEST(LayerRules, FenceGraphicsAndToolLibraries) {
  EXPECT_EQ(lines_found("firmware-host/app/a.cpp", "#include <EGL/egl.h>\n"), Lines{2});
  EXPECT_EQ(lines_found("render/egl/a.cpp", "#include <GLES3/gl31.h>\n"), Lines{});
  for (const std::string header : {"opencv2/core.hpp", "ceres/ceres.h", "itkImage.h", "vtkPolyData.h"}) {
    EXPECT_EQ(lines_found("firmware-host/files/a.cpp", "#include <" + header + ">\n"), Lines{2}) << header;
    EXPECT_EQ(lines_found("tools/surface/a.cpp", "#include <" + header + ">\n"), Lines{}) << header;
  }
}

TEST(LayerRules, RefuseAnIncludeThatDoesNotStartAtTheRoot) {
  EXPECT_EQ(lines_found("realtime/base/a.cpp", "#include \"a.hpp\"\n"), Lines{2});
}

TEST(LayerRules, KeepExceptionsAndStreamsOutOfRealTimeFolders) {
  const std::string body =
      "#include <iostream>\nvoid f() { throw 1; }\nvoid g() { try { f(); } catch (int) {} }\n";
  EXPECT_EQ(lines_found("realtime/sync/a.cpp", body), (Lines{2, 3, 4, 4}));
  EXPECT_EQ(lines_found("firmware-host/stages/a.cpp", body), (Lines{2, 3, 4, 4}));
  EXPECT_EQ(lines_found("firmware-host/files/a.cpp", body), Lines{});
  EXPECT_EQ(lines_found("realtime/sync/a.cpp", "std::shared_ptr<int> p;\nstd::function<void()> f;\n"),
            (Lines{2, 3}));
}

TEST(LayerRules, TakeNoWordForAnother) {
  EXPECT_EQ(lines_found("realtime/sync/a.cpp", "int retry; bool try_push(); int throws;\n"), Lines{});
}

TEST(LayerRules, ReadCodeOnly) {
  const std::string body =
      "\n// try this\n/* throw\n that */ const char* a = \"try\\\" catch\"; char b = '\"'; int c = 1'000;\n"
      "auto d = R\"x(\n#include \"board/sim/a.hpp\"\n)x\";\n";
  EXPECT_EQ(lines_found("realtime/sync/a.cpp", body), Lines{});
  EXPECT_EQ(lines_found("realtime/sync/a.cpp", body + "#include \"board/sim/a.hpp\"\n"), Lines{9});
}

TEST(LayerRules, AskForAnOpeningSentence) {
  EXPECT_EQ(check({"render/a.hpp", "#pragma once\n"}).size(), 1U);
  EXPECT_EQ(check({"render/a.hpp", ""}).size(), 1U);
  EXPECT_EQ(check({"render/a.hpp", "// no full stop\n#pragma once\n"}).size(), 1U);
  EXPECT_EQ(check({"render/a.hpp", "// A sentence that\n// goes on.\n#pragma once\n"}).size(), 0U);
}

}  // namespace
}  // namespace orcart::layers
