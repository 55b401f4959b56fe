// Every panel unfolded, something chosen in each: what is said of every control and read-out, whether something is cut
// off or lies over something else, and what it costs.
#include <gtest/gtest.h>

#if IRAD_OIIO

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <climits>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "gi/settings.h"
#include "renderer/scene/material_edits.h"
#include "tests/png.h"
#include "tests/window_fixture.h"
#include "ui/panel.h"

namespace irad::test::window_panels_suite {
namespace {

bool isSetting(const std::string& name) {
  return std::ranges::any_of(settingTable(), [&](const Setting& setting) { return name == setting.name; });
}

class WindowPanelsTest : public WindowTest {
 protected:
  std::map<std::string, std::string> helps_;  ///< by the control's name: what is said while the mouse rests on it
  std::set<std::string> faults_;              ///< of how they are laid out
  int width_ = 0, height_ = 0;                ///< of the window
  int margin_ = 5;                            ///< by which rows of lists are wider than their text, pixels

  void begin(const std::string& size, const std::string& scale) {
    firstSizes_ = true;
    fold("[]");
    windowSize_ = size;
    width_ = std::stoi(size);
    height_ = std::stoi(size.substr(size.find('x') + 1));
    margin_ = static_cast<int>(5 * std::stof(scale));
    start({"--inspect", "7,1,13", "--view", "depth", "--scale", scale});
    rests();
    click("View/Histogram");
    // The rows of a list are there once what is below it is in view.
    shown("Objects/Hide");
    click("Objects/1");
    const Scene box = loadScene(assets() / "box.glb");
    shown("Objects/search");
    shown("Materials/Save");
    click("Materials/" + materialNames(box).at(box.draws.front().material));
    shown("Lights/handles in the picture");
    click("Lights/0");
  }
  /// A panel's header, a control in it, or a read-out.
  static bool ofPanel(const std::string& name) {
    const std::string title = name.substr(0, name.find('/'));
    const Panels panels = makePanels();
    return std::ranges::any_of(panels, [&](const auto& panel) { return title == panel->title(); });
  }
  void look(const std::string& where) {
    std::istringstream lines(slurp(controlsFile().string() + ".help"));
    for (std::string line; std::getline(lines, line);)
      if (const size_t tab = line.find('\t'); tab != line.npos && ofPanel(line))
        helps_[line.substr(0, tab)] = line.substr(tab + 1);
    findFaults();
    // To be looked at by a person: IRAD_SHOTS=FOLDER keeps them.
    if (const char* folder = std::getenv("IRAD_SHOTS")) {
      std::filesystem::create_directories(folder);
      writePng(std::filesystem::path(folder) / (where + ".png"), screen_->grab(0, 0, width_, height_));
    }
  }
  /// What reaches out of its region to the side, but in tables, which scroll sideways; and what lies over another.
  void findFaults() {
    std::vector<Control> all = controls();
    std::erase_if(all, [](const Control& c) { return !ofPanel(c.name) || isCell(c.name) || c.area.width == 0; });
    for (const Control& c : all)
      if (c.area.x < c.region.x - margin_ || c.area.right() > c.region.right() + margin_)
        faults_.insert(fmt::format("{} is cut off: {} to {} of {} to {}", c.name, c.area.x, c.area.right(), c.region.x,
                                   c.region.right()));
    for (size_t a = 0; a < all.size(); ++a)
      for (size_t b = a + 1; b < all.size(); ++b) {
        const Control::Area &p = all[a].area, &q = all[b].area;
        const int wide = std::min(p.right(), q.right()) - std::max(p.x, q.x);
        const int high = std::min(p.bottom(), q.bottom()) - std::max(p.y, q.y);
        if (wide > 1 && high > 1 && !mayLieOver(all[b].name, all[a].name) && !mayLieOver(all[a].name, all[b].name))
          faults_.insert(fmt::format("{} lies over {}", all[b].name, all[a].name));
      }
  }
  /// Cells of tables and ends of ranges: they say what they are in their headers, or under the mouse.
  static bool isCell(const std::string& name) {
    if (name.starts_with("Compare/result/")) return true;
    if (name.starts_with("View/histogram/")) return name.find("channels") == name.npos;
    if (name.starts_with("Inspector/"))
      return std::isdigit(static_cast<unsigned char>(name[10])) != 0 || isHeader(name);
    const bool ofTimings = name.starts_with("Timings/") && (name.find('=') != name.npos || name.find(',') != name.npos);
    return ofTimings || name.starts_with("Timings/##");
  }
  static bool isHeader(const std::string& name) {
    const std::string title = name.substr(name.rfind('/') + 1);
    return title == "voxel" || title == "hits" || title == "m" || title == "F" || title == "F B";
  }
  /// Buttons at the end of a group's line, in the colour of changed ones.
  static bool mayLieOver(const std::string& over, const std::string& under) { return over == under + "/reset"; }
  /// From the top of both columns to their ends: lists that are out of view are not drawn.
  void lookThrough(const std::string& name) {
    std::map<Region, std::vector<std::string>> titles;
    for (const auto& panel : makePanels()) titles[panel->region()].emplace_back(panel->title());
    for (const char* tab : {"Table", "One-time", "Compare", "Plot"}) {
      click(std::string("Timings/") + tab);
      goAside();  // its tooltip lies over the strip
      rests();
      look(fmt::format("{}-{}", name, tab));
    }
    for (const auto& [side, region] : {std::pair("left", Region::Left), std::pair("right", Region::Right)}) {
      const std::string last = titles[region].back();
      const Control first = control(titles[region].front());
      act(fmt::format("mousemove {} {} click --repeat 150 --delay 1 4", first.region.x + 3, first.region.y + 5));
      rests();
      int shot = 0;
      for (int before = INT_MAX; control(last).area.y < before;) {
        before = control(last).area.y;
        look(fmt::format("{}-{}-{}", name, side, shot++));
        act("click --repeat 8 --delay 1 5");
        rests();
      }
    }
    EXPECT_EQ(fmt::format("{}", fmt::join(faults_, "\n")), "") << name;
  }
};

TEST_F(WindowPanelsTest, EveryControlAndReadOutSaysWhatItIs) {
  begin("1280x720", "1");
  lookThrough("1280x720");
  // A list that is at its top passes the wheel on to its column, which is at its end.
  const Control row = shown("Objects/1");
  const int before = control("Cameras").area.y;
  act(fmt::format("mousemove {} {} click --repeat 20 --delay 5 4", row.region.x + row.region.width / 2,
                  row.region.y + row.region.height / 2));
  rests();
  EXPECT_GT(control("Cameras").area.y, before) << "the list keeps the wheel";
  click("Compare/Compare with these settings");
  shown("Compare/End the comparison");
  look("compare");
  EXPECT_GT(control("Compare/result/relMSE").area.width, 50) << "the table begins with narrow columns";
  // A picker that opens low in the column is in the window with all of it.
  shown("Scene/open");
  click("Materials/white wall/base/pick");
  EXPECT_LE(control("Materials/white wall/base/hex").area.bottom(), height_);
  hold("Escape");
  EXPECT_GT(helps_.size(), 250u) << "not all panels are open";
  // The rules that cannot be read off a number.
  EXPECT_TRUE(contains(helps_["Lights/0/intensity"], "1 cd = 1 W/sr"));
  EXPECT_TRUE(std::ranges::any_of(helps_, [](const auto& help) {
    return help.first.starts_with("Inspector/emitters=") && contains(help.second, "Negative:");
  })) << "what a negative correction means is not said";
  EXPECT_TRUE(helps_.contains("Inspector/F") && helps_.contains("Inspector/F B"));
  for (const auto& [name, help] : helps_) {
    if (isCell(name)) continue;
    EXPECT_NE(help, "") << name << " says nothing";
    // Of a setting: what it is, what it may be, what it is at first.
    const std::string setting = name.substr(name.find('/') + 1);
    if (!name.starts_with("Settings/") || !isSetting(setting)) continue;
    EXPECT_TRUE(help.starts_with(setting)) << name << ": " << help;
    EXPECT_TRUE(contains(help, "Allowed: ") && contains(help, "Default: ")) << name << ": " << help;
  }
  if (const char* folder = std::getenv("IRAD_SHOTS"))
    for (std::ofstream out(std::filesystem::path(folder) / "helps.txt"); const auto& [name, help] : helps_)
      out << name << "\n    " << help << "\n";
  quit();
}

TEST_F(WindowPanelsTest, NothingIsCutOffOrLiesOverAnotherInALargerWindow) {
  begin("1600x900", "1");
  lookThrough("1600x900");
  quit();
}

TEST_F(WindowPanelsTest, NothingIsCutOffOrLiesOverAnotherWithLargeText) {
  begin("1280x720", "1.5");
  lookThrough("1280x720-1.5");
  quit();
}

/// Processor time of the window's own thread for a frame's panels, handles and their triangles, with every panel open
/// and something chosen in each: not the picture, nor the wait for the device. Other programs on the machine make it
/// longer, never shorter, and other tests run beside this one: the quietest frames in a row count.
TEST_F(WindowPanelsTest, TakeLessThanAMillisecondOfTheThread) {
  std::string log;
  for (int turn = 0; turn < 15 && !contains(log, "mark: < 1 ms: held"); ++turn) {
    Program bench({iradProgram(), "bench", "box", "--ui", "--set", "voxel.resolution=16", "--set", "matrix.rays=16",
                   "--set", "specular.mode=off", "--frames", "40"},
                  folder_.path, screen_->environment());
    ASSERT_EQ(bench.wait(300), 0) << bench.log();
    log = bench.log();
    std::cerr << log;
  }
  EXPECT_TRUE(contains(log, "mark: < 1 ms: held")) << log;
}

}  // namespace
}  // namespace irad::test::window_panels_suite

#else

TEST(WindowPanels, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_OIIO";
}

#endif
