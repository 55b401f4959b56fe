// The only file that knows the command-line library: it costs nine seconds of compilation.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <new>

#include "app/arguments.h"
#include "app/command.h"
#include "app/devices.h"
#include "app/version.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"

namespace irad::app {
namespace {

/// Of options that are given at most once; checkValues() refuses the others.
constexpr auto kOnce = CLI::MultiOptionPolicy::TakeLast;

class CliOptions : public Options {
 public:
  explicit CliOptions(CLI::App& app) : app_(app) {}

  void flag(const std::string& name, bool& value, const std::string& help) override {
    app_.add_flag(name, value, help);
  }
  void value(const std::string& name, const std::string& placeholder, std::optional<std::string>& value,
             const std::string& help) override {
    app_.add_option(name, value, help)->type_name(placeholder)->multi_option_policy(kOnce);
  }
  void values(const std::string& name, const std::string& placeholder, std::vector<std::string>& values,
              const std::string& help) override {
    app_.add_option(name, values, help)->type_name(placeholder)->allow_extra_args(false);
  }
  void pair(const std::string& name, const std::string& placeholder,
            std::optional<std::pair<std::string, std::string>>& value, const std::string& help) override {
    app_.add_option(name, value, help)->type_name(placeholder)->multi_option_policy(kOnce);
  }
  void argument(const std::string& name, std::optional<std::string>& value, const std::string& help) override {
    app_.add_option(name, value, help)->type_name("");
  }
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help) override {
    app_.add_option(name, values, help)->type_name("");
  }

 private:
  CLI::App& app_;
};

std::vector<std::string> optionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// What the parser did not recognize, in our words.
void refuseExtras(const CLI::App& app, const std::string& where) {
  const std::vector<std::string> extras = app.remaining();
  if (extras.empty()) return;
  for (const std::string& extra : extras) {
    if (extra.size() < 2 || extra[0] != '-') continue;
    const std::string name = extra.substr(0, extra.find('='));
    const std::vector<std::string> close = nearMatches(name, optionNames(app));
    std::string message = fmt::format("{}: unknown option '{}'", where, name);
    if (!close.empty()) message += suggestion(name, optionNames(app));
    throw UsageError(message + fmt::format("; '{} --help' lists them", where));
  }
  throw UsageError(fmt::format("{}: unexpected argument '{}'", where, extras.front()));
}

/// An option given twice is an error, neither value is chosen silently; so is an empty value, which a script's unset
/// variable makes.
void checkValues(const CLI::App& app, const std::string& where) {
  for (const CLI::Option* option : app.get_options()) {
    const auto expected = static_cast<size_t>(std::max(option->get_items_expected_max(), 0));
    if (option->count() == 0 || expected == 0) continue;
    const std::string name = option->get_name();
    if (option->get_multi_option_policy() == kOnce && option->count() > expected)
      throw UsageError(
          fmt::format("{}: {} is given {} times; it may be given once", where, name, option->count() / expected));
    for (const std::string& value : option->results())
      if (value.empty()) throw UsageError(fmt::format("{}: {} is empty", where, name));
  }
}

struct Parsed {
  const Command* command = nullptr;
  bool done = false;  ///< --help, --version and the like have been answered
};

Parsed parse(CLI::App& app, int argc, const char* const* argv, const std::vector<Command>& commands) {
  bool listDevices = false, version = false;
  app.allow_extras();
  app.add_flag("--version", version, "Print version and commit");
  app.add_flag("--list-devices", listDevices, "Print the Vulkan devices and what each lacks");
  std::vector<CLI::App*> subcommands;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    sub->allow_extras();
    CliOptions options(*sub);
    command.declare(options);
    subcommands.push_back(sub);
  }
  app.footer(fmt::format(
      "Built-in scenes: {}.\n"
      "Exit status: 0 done, 1 the work failed, 2 bad usage, 3 bad input file, 4 no suitable device or memory.",
      fmt::join(builtInScenes(), ", ")));
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    print("{}", app.help());  // the help of the subcommand, where one was named
    return {nullptr, true};
  } catch (const CLI::ArgumentMismatch& error) {
    // "--out: 1 required DIR missing"
    const std::string text = error.what();
    const size_t colon = text.find(": "), wanted = text.find(" required "), end = text.rfind(" missing");
    if (colon == text.npos || wanted == text.npos || end == text.npos || end < wanted + 10) throw UsageError(text);
    throw UsageError(fmt::format("{}: its value is missing: {}", text.substr(0, colon),
                                 text.substr(wanted + 10, end - wanted - 10)));
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  if (version) {
    print("irad {} ({})\n", versionNumber(), versionCommit());
    return {nullptr, true};
  }
  if (listDevices) {
    printDevices(/*json=*/false);
    return {nullptr, true};
  }
  for (size_t i = 0; i < commands.size(); ++i) {
    if (!subcommands[i]->parsed()) continue;
    refuseExtras(*subcommands[i], "irad " + commands[i].name);
    checkValues(*subcommands[i], "irad " + commands[i].name);
    return {&commands[i], false};
  }
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  const std::vector<std::string> extras = app.remaining();
  if (!extras.empty() && extras.front()[0] != '-')
    throw UsageError(fmt::format("unknown command '{}'{}", extras.front(), suggestion(extras.front(), names)));
  refuseExtras(app, "irad");
  throw UsageError("no command given\n\n" + app.help());
}

void run(int argc, const char* const* argv, Machine& machine) {
  CLI::App app("Voxel-radiosity global illumination: interactive viewer and headless tool", "irad");
  const std::vector<Command> commands = allCommands();
  const Parsed parsed = parse(app, argc, argv, commands);
  if (!parsed.done) parsed.command->run(machine);
  flushStandardOutput();
}

}  // namespace

int runProgram(int argc, const char* const* argv, Machine& machine) {
  holdStandardStreams();
  // A file-size limit should show as a failed write with a message instead of ending the process.
  std::signal(SIGXFSZ, SIG_IGN);
  const auto report = [](const char* message) { tell("irad: error: {}\n", message); };
  try {
    run(argc, argv, machine);
    return 0;
  } catch (const Error& error) {
    report(error.what());
    return error.exitStatus;
  } catch (const std::bad_alloc&) {
    report("out of memory");
    return 4;
  } catch (const std::exception& error) {
    report(error.what());
    return 1;
  }
}

}  // namespace irad::app
