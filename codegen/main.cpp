#include "codegen/command.h"

int main(int argc, char** argv) { return tightrope::codegen::run_command(argc, argv); }
