#include "app/command.h"
#include "app/machine.h"

int main(int argc, char** argv) {
  irad::app::Machine machine;
  return irad::app::runProgram(argc, argv, machine);
}
