// The main of every test program: GoogleTest's, and --suites=NAME,NAME, which runs the tests of tests/NAME_test.cpp
// alone (those of them that --gtest_filter lets through). With IRAD_TEST_QUICK set those of tests/slow.txt are left
// out. Beside the times, the results have each test's file and processor seconds, which say more where other things
// run.
#include <fnmatch.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support.h"

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) out.push_back(part);
  return out;
}

/// GoogleTest's filter that lets through what `filter` does of these suites; none where a suite has no test here.
std::string filterOf(const std::vector<std::string>& suites, const std::string& filter) {
  const size_t dash = filter.find('-');
  const std::vector<std::string> wanted = split(dash == 0 ? "*" : filter.substr(0, dash), ':');
  const std::string unwanted = dash == std::string::npos ? "" : filter.substr(dash);
  std::set<std::string> missing;
  for (const std::string& suite : suites) missing.insert(suite + "_test");
  const std::set<std::string> files = missing;
  std::string out;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i)
    for (int j = 0; j < all.GetTestSuite(i)->total_test_count(); ++j) {
      const testing::TestInfo& test = *all.GetTestSuite(i)->GetTestInfo(j);
      const std::string file = std::filesystem::path(test.file()).stem();
      if (files.count(file) == 0) continue;
      missing.erase(file);
      const std::string name = std::string(test.test_suite_name()) + "." + test.name();
      for (const std::string& pattern : wanted)
        if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) {
          out += (out.empty() ? "" : ":") + name;
          break;
        }
    }
  for (const std::string& file : missing) std::fprintf(stderr, "no test of %s.cpp is in this program\n", file.c_str());
  if (!missing.empty()) return {};
  // Where the filter leaves nothing of them, nothing runs; an empty filter would mean everything.
  return (out.empty() ? "no test" : out) + unwanted;
}

/// `filter` without the tests of tests/slow.txt.
std::string withoutSlow(const std::string& filter) {
  std::string slow;
  for (const std::string& name : split(irad::test::slurp(irad::test::sourceFolder() / "tests" / "slow.txt"), '\n'))
    if (name.front() != '#') slow += ":" + name;
  return filter + (filter.find('-') == std::string::npos ? "-" : "") + slow;
}

/// Processor time of this process, of those that it has waited for, and of those that outlive a test.
double processorSeconds() {
  double seconds = 0;
  for (const pid_t process : irad::test::lastingProcesses()) seconds += irad::test::processorSeconds(process);
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    for (const timeval t : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  }
  return seconds;
}

class Meter : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { before_ = processorSeconds(); }
  void OnTestEnd(const testing::TestInfo& test) override {
    testing::Test::RecordProperty("suite", std::filesystem::path(test.file()).stem());
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.2f", processorSeconds() - before_);
    testing::Test::RecordProperty("processor_seconds", seconds);
  }
  double before_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const std::string option = "--suites=";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind(option, 0) != 0) {
      std::fprintf(stderr, "unknown argument %s\n", argv[i]);
      return 2;
    }
    const std::string filter = filterOf(split(argument.substr(option.size()), ','), testing::GTEST_FLAG(filter));
    if (filter.empty()) return 2;
    testing::GTEST_FLAG(filter) = filter;
  }
  if (std::getenv("IRAD_TEST_QUICK") != nullptr) testing::GTEST_FLAG(filter) = withoutSlow(testing::GTEST_FLAG(filter));
  testing::UnitTest::GetInstance()->listeners().Append(new Meter);
  return RUN_ALL_TESTS();
}
