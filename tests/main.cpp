// The main of every test program. The log starts before any thread, as in the service.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "server/support/log.h"

int main(int argc, char** argv) {
    lastflat::server::start_log();
    return doctest::Context(argc, argv).run();
}
