#include "app/command.h"

int main(int argc, char** argv) {
  using namespace irad::app;
  return runProgram(argc, argv,
                    {
#if IRAD_UI
                        viewCommand(),
#endif
                        renderCommand(),
                        benchCommand(),
                        checkCommand(),
                        memoryCommand(),
                        planCommand(),
                        referenceCommand(),
                        writebackCommand(),
                        exportCommand(),
                        settingsCommand(),
                        studyCommand(),
                        tuneCommand(),
                        viewsCommand(),
                    });
}
