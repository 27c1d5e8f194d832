#include "cli/app.h"

int main(int argc, char** argv) { return kerf::bench::run_program(argc, argv); }
