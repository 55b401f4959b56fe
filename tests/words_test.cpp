// The window's words: counts and shares, the glossary, which settings a search finds.
#include <gtest/gtest.h>

#if IRAD_UI

#include <set>
#include <string>

#include "gi/setting_words.h"
#include "tests/support.h"
#include "ui/glossary.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/words.h"

namespace irad::words_suite {
namespace {

TEST(Words, CountsAreSingularAndPlural) {
  EXPECT_EQ(counted(0, "sweep"), "0 sweeps");
  EXPECT_EQ(counted(1, "sweep"), "1 sweep");
  EXPECT_EQ(counted(12000, "sweep"), "12,000 sweeps");
  EXPECT_EQ(counted(1, "penumbra", "penumbrae"), "1 penumbra");
  EXPECT_EQ(counted(2, "penumbra", "penumbrae"), "2 penumbrae");
}

/// Letters are written as escapes where the window's texts are.
TEST(Words, TheFontsHoldEveryLetter) {
  size_t found = 0;
  for (const char* room : {"ui", "gi"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::sourceFolder() / room)) {
      if (!entry.is_regular_file()) continue;
      const std::string text = test::slurp(entry.path());
      for (size_t at = 0; (at = text.find("\\u", at)) != std::string::npos; ++at, ++found) {
        const std::string code = text.substr(at + 2, 4);
        EXPECT_TRUE(fontsHold(static_cast<uint32_t>(std::stoul(code, nullptr, 16)))) << entry.path() << ": " << code;
      }
    }
  EXPECT_GT(found, 100u);
}

TEST(Words, WhatRoundsToZeroHasNoSign) {
  EXPECT_EQ(percentText(-0.00001, 2, true), "0.00 %");
  EXPECT_EQ(percentText(0.00001, 2, true), "0.00 %");
  EXPECT_EQ(percentText(0, 2), "0.00 %");
  EXPECT_EQ(percentText(-0.00006, 2, true), "-0.01 %");
  EXPECT_EQ(percentText(0.00006, 2, true), "+0.01 %");
  EXPECT_EQ(percentText(0.123, 1), "12.3 %");
}

TEST(Words, ReadOutsKeepTheirDigits) {
  EXPECT_EQ(withDigits(0.036), "0.0360");
  EXPECT_EQ(withDigits(1.7), "1.70");
  EXPECT_EQ(withDigits(100), "100") << "no point without digits after it";
  EXPECT_EQ(withDigits(-2), "-2.00");
  EXPECT_EQ(withDigits(1.2e-6), "1.20e-06");
  EXPECT_EQ(withDigits(0), "0");
  EXPECT_EQ(withDigits(2.5, 2), "2.5");
}

TEST(Words, TheGlossaryHasTheLettersOfThePanels) {
  std::set<std::string> symbols;
  for (const Term& term : glossary()) {
    EXPECT_TRUE(symbols.insert(term.symbol).second) << term.symbol << " twice";
    EXPECT_NE(std::string(term.meaning), "") << term.symbol;
  }
  for (const char* needed : {"D", "H", "B", "M", "F", "\u03C1", "\u03BB", "residual", "bound"})
    EXPECT_TRUE(symbols.contains(needed)) << needed;
}

TEST(Words, SettingsAreCalledByWordsAndTheirGroupsSayWhatTheyAreAbout) {
  EXPECT_EQ(settingLabel("solver.sweeps_per_frame"), "sweeps per frame");
  EXPECT_EQ(settingLabel("solver.omega"), "relaxation \u03C9");
  for (const Setting& setting : settingTable()) {
    EXPECT_GT(settingLabel(setting.name).size(), 2u) << setting.name << " is called by a letter";
    EXPECT_FALSE(settingGroupHelp(setting.group()).empty()) << setting.group();
  }
  EXPECT_TRUE(settingGroupHelp("no such group").empty());
}

TEST(SettingFilter, FindsNamesAndMeaningsAndWhatIsChanged) {
  const Settings defaults;
  Settings settings = defaults;
  const auto found = [&](const SettingFilter& filter) {
    std::set<std::string> names;
    for (const Setting& setting : settingTable())
      if (filter.passes(setting, settings, defaults)) names.insert(setting.name);
    return names;
  };
  const size_t all = found({}).size();
  EXPECT_EQ(all, settingTable().size());
  EXPECT_FALSE(SettingFilter{.words = "  "}.on());
  EXPECT_EQ(found({.words = "  "}).size(), all);
  EXPECT_TRUE(found({.words = "VOXEL resolution"}).contains("voxel.resolution"));
  EXPECT_TRUE(found({.words = "jfa pass"}).contains("view.jfa_pass")) << "an underscore is a space";
  EXPECT_TRUE(found({.words = "jfa_pass"}).contains("view.jfa_pass"));
  EXPECT_TRUE(found({.words = "relaxation"}).contains("solver.omega")) << "by its meaning";
  EXPECT_TRUE(found({.words = "relaxation nothing-like-this"}).empty());
  EXPECT_TRUE(found({.changedOnly = true}).empty());
  settings.voxel.resolution = defaults.voxel.resolution + 1;
  EXPECT_EQ(found({.changedOnly = true}), std::set<std::string>{"voxel.resolution"});
  EXPECT_TRUE(found({.words = "omega", .changedOnly = true}).empty()) << "both must hold";
}

}  // namespace
}  // namespace irad::words_suite

#else

TEST(Words, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
