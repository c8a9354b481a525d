// The worker: a program of its own, started by the service for each job.
#include "server/worker/work.h"

int main() {
    lastflat::server::work_command();
}
