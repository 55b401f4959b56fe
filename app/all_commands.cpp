#include "app/command.h"

namespace irad::app {

std::vector<Command> allCommands() {
  return {
#if IRAD_UI
    viewCommand(),
#endif
        renderCommand(), benchCommand(), checkCommand(), memoryCommand(), planCommand(), referenceCommand(),
        writebackCommand(), exportCommand(), settingsCommand(), studyCommand(), tuneCommand(), viewsCommand(),
  };
}

}  // namespace irad::app
