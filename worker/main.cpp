// bandsaw-worker: renders bands for a coordinator until it is stopped.

#include "worker/command.h"

int main(int argc, char** argv) { return bandsaw::worker::run_command(argc, argv); }
