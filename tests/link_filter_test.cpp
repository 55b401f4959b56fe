// The filter over the links of a row, as it is typed.
#include <gtest/gtest.h>

#if IRAD_UI

#include "ui/link_filter.h"

namespace irad::link_filter_suite {
namespace {

/// Voxel, hits, distance, B (grey).
Link link(glm::uvec3 voxel, uint32_t hits, double distance, double b) {
  Link l;
  l.voxel = voxel;
  l.hits = hits;
  l.distance = distance;
  l.formFactor = hits / 100.0;
  l.radiosity = glm::dvec3(b);
  l.contribution = l.formFactor * l.radiosity;
  return l;
}
const std::vector<Link> kLinks{link({1, 2, 3}, 2, 4.5, 0.05), link({12, 3, 40}, 3, 9.5, 0.2),
                               link({7, 40, 12}, 8, 10, 1.5)};

std::string passing(const char* text) {
  const LinkFilter filter(text);
  std::string out;
  for (size_t i = 0; i < kLinks.size(); ++i)
    if (filter.passes(kLinks[i])) out += static_cast<char>('0' + i);
  return out;
}

TEST(LinkFilter, ShowsWhatItSays) {
  const std::pair<const char*, const char*> known[] = {
      {"", "012"},      {"12", "12"},          {"12 3", "1"},       {"1 2, 7 4", "02"}, {"-40", "0"},
      {"12, -7", "1"},  {"hits>=3", "12"},     {"hits > 3", "2"},   {"dist<10", "01"},  {"dist<=10", "012"},
      {"B>.1", "12"},   {"F=0.03", "1"},       {"hits!=3", "02"},   {"x<10,y>3", "2"},  {"z = 12", "2"},
      {"FB>0.01", "2"}, {"hits>2, 12 3", "1"}, {"dist<10,B>1", ""}, {" , ,-", "012"},   {"hits>-1e3", "012"},
  };
  for (const auto& [text, links] : known) {
    EXPECT_EQ(passing(text), links) << text;
    EXPECT_TRUE(LinkFilter(text).errors().empty()) << text;
  }
}

TEST(LinkFilter, SaysWhatItCannotReadAndLetsThatPass) {
  const std::pair<const char*, const char*> wrong[] = {
      {"hist>3", "'hist' is no quantity (did you mean"},
      {"hits>", "'' is no number"},
      {"hits>3x", "'3x' is no number"},
      {"hits==3", "== is none of"},
      {">3", "'' is no quantity"},
      {"hits!3", "! is none of"},
  };
  for (const auto& [text, part] : wrong) {
    const LinkFilter filter(text);
    ASSERT_EQ(filter.errors().size(), 1u) << text;
    EXPECT_NE(filter.errors()[0].find(part), std::string::npos) << text << ": " << filter.errors()[0];
    EXPECT_EQ(passing(text), "012") << text;
  }
  EXPECT_EQ(passing("hist>3, hits>2"), "12") << "what can be read holds";
}

TEST(LinkScale, IsLogarithmicWhereStrengthsSpanDecades) {
  const LinkScale even = linkScale(0.5f, 2);
  EXPECT_FALSE(even.logarithmic);
  EXPECT_EQ(even.at(1), 0.5f);
  EXPECT_EQ(even.at(2), 1);
  EXPECT_EQ(even.at(0), 0);
  const LinkScale wide = linkScale(0.02f, 2);
  EXPECT_TRUE(wide.logarithmic);
  EXPECT_NEAR(wide.at(0.2f), 0.5f, 1e-6f);
  EXPECT_EQ(wide.at(2), 1);
  EXPECT_EQ(wide.at(0.02f), 0);
  EXPECT_EQ(wide.at(0), 0) << "none";
  // More than six decades would leave what is strong all one colour.
  EXPECT_EQ(linkScale(1e-12f, 1).low, 1e-6f);
  EXPECT_EQ(linkScale(0, 0).at(1), 0) << "there is no link";
}

}  // namespace
}  // namespace irad::link_filter_suite

#else

TEST(LinkFilter, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
