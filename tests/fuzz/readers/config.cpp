// --config: a file of settings, or the manifest of an earlier run.
#include "app/arguments.h"
#include "tests/fuzz/readers.h"

void irad::fuzz::config(Bytes bytes) {
  app::SettingArguments arguments;
  arguments.config = scratchFile("config.json", bytes).string();
  arguments.resolve(arguments.readConfig(), /*cpuDevice=*/true);
}
