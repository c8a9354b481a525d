// The program lastflat-work, of which each worker is a process.
#include "server/worker/work.h"

int main() {
    lastflat::server::work_command();
}
