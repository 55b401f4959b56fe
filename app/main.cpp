#include "app/command.h"

int main(int argc, char** argv) {
  using namespace irad::app;
  return runProgram(argc, argv,
                    {
                        renderCommand(),
                        benchCommand(),
                        exportCommand(),
                        settingsCommand(),
                        viewsCommand(),
                    });
}
