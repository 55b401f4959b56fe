// The hard cases of `irad check` on this device, under validation (docs/stability.md), the soak shortened; `irad check`
// without --quick runs that at full length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gi/check/check.h"
#include "tests/support.h"

namespace irad::test::catalogue_suite {
namespace {

class Catalogue : public GpuTest, public ::testing::WithParamInterface<CheckCase> {};

TEST_P(Catalogue, HoldsItsMark) {
  const CheckCase& check = GetParam();
  if (check.pending != nullptr) GTEST_SKIP() << check.name << ": " << check.pending;
  Settings settings = defaultSettings(context().device.isCpu);
  applyCheckSizes(settings);
  const CheckOptions options{.quick = true, .program = iradProgram(), .scenes = {assets() / "box.glb"}};
  const CheckOutcome outcome = runCheck(context(), check, settings, options);
  EXPECT_EQ(outcome.error, "");
  for (const CheckFigure& figure : outcome.figures) {
    fmt::print("{}{} = {:.6g} (mark {})\n", figure.passed() ? "  " : "! ", figure.name, figure.value, figure.mark);
    EXPECT_TRUE(figure.passed()) << figure.name << " = " << figure.value << ", mark " << figure.mark;
  }
  EXPECT_FALSE(outcome.figures.empty());
}

std::vector<CheckCase> casesThat(bool soak) {
  std::vector<CheckCase> out;
  for (const CheckCase& check : checkCases())
    if (check.soak == soak) out.push_back(check);
  return out;
}
std::string caseName(const ::testing::TestParamInfo<CheckCase>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(Case, Catalogue, ::testing::ValuesIn(casesThat(/*soak=*/false)), caseName);
INSTANTIATE_TEST_SUITE_P(Soak, Catalogue, ::testing::ValuesIn(casesThat(/*soak=*/true)), caseName);

TEST(CatalogueFrame, NamesAreUniqueAndDescribed) {
  std::set<std::string> names;
  for (const CheckCase& check : checkCases()) {
    EXPECT_TRUE(names.insert(check.name).second) << check.name << " twice";
    for (const char* text : {check.setup, check.oracle, check.mark}) EXPECT_GT(std::string_view(text).size(), 0u);
    EXPECT_TRUE(check.run != nullptr || check.pending != nullptr) << check.name;
  }
}

TEST(CatalogueFrame, FiguresAreJudgedByTheirMarks) {
  CheckRun run(*gpu().context, Settings{}, CheckOptions{});
  const auto last = [&] { return run.figures.back().passed(); };
  run.near("inside", 1.009, 1, 0.01);
  EXPECT_TRUE(last());
  run.near("outside", 0.989, 1, 0.01);
  EXPECT_FALSE(last());
  run.near("not a number", std::nan(""), 1, 10);
  EXPECT_FALSE(last());
  run.near("exact", 1, 1, 0);
  EXPECT_TRUE(last());
  run.atMost("at the limit", 2, 2);
  EXPECT_TRUE(last());
  run.atMost("above", 2.001, 2);
  EXPECT_FALSE(last());
  run.atMost("above nothing", 1e-30, 0);
  EXPECT_FALSE(last());
  run.atLeast("at the limit", 0.99, 0.99);
  EXPECT_TRUE(last());
  run.atLeast("below", 0.9899, 0.99);
  EXPECT_FALSE(last());
  run.atLeast("not a number", std::nan(""), 0.99);
  EXPECT_FALSE(last());
  run.none("one", 1);
  EXPECT_FALSE(last());
  run.info("printed", std::nan(""));
  EXPECT_TRUE(last());
}

}  // namespace
}  // namespace irad::test::catalogue_suite
