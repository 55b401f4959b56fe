// A subcommand: its options and its work. The command-line library is known to command_line.cpp alone.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace irad::app {

class Machine;

/// Declares options; values arrive before Command::run is called.
class Options {
 public:
  virtual ~Options() = default;
  virtual void flag(const std::string& name, bool& value, const std::string& help) = 0;
  /// An option given at most once.
  virtual void value(const std::string& name, const std::string& placeholder, std::optional<std::string>& value,
                     const std::string& help) = 0;
  /// An option that may be repeated, one value each time.
  virtual void values(const std::string& name, const std::string& placeholder, std::vector<std::string>& values,
                      const std::string& help) = 0;
  /// An option given at most once, followed by two values.
  virtual void pair(const std::string& name, const std::string& placeholder,
                    std::optional<std::pair<std::string, std::string>>& value, const std::string& help) = 0;
  /// The bare argument, which may be absent.
  virtual void argument(const std::string& name, std::optional<std::string>& value, const std::string& help) = 0;
  /// Any number of bare arguments.
  virtual void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help) = 0;
};

struct Command {
  std::string name, summary;
  std::function<void(Options&)> declare;
  std::function<void(Machine&)> run;  ///< throws the errors of renderer/base/error.h
};

Command renderCommand();
Command benchCommand();
Command checkCommand();
Command exportCommand();
Command memoryCommand();
Command planCommand();
Command referenceCommand();
Command settingsCommand();
Command studyCommand();
Command tuneCommand();
Command viewCommand();  ///< in builds with IRAD_UI
Command viewsCommand();
Command writebackCommand();

std::vector<Command> allCommands();  ///< in the order in which help lists them

/// Parses, runs, reports. The exit status: 0 done, 1 the work failed, 2 bad usage, 3 bad input file, 4 no
/// suitable device or not enough memory.
int runProgram(int argc, const char* const* argv, Machine& machine);

}  // namespace irad::app
