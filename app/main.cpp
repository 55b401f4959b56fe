#include "app/command.h"

int main(int argc, char** argv) {
  using namespace irad::app;
  return runProgram(argc, argv,
                    {
                        settingsCommand(),
                    });
}
