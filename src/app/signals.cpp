// SPDX-License-Identifier: MIT
#include "app/signals.hpp"

#include <csignal>

namespace meltray::app {
namespace {

volatile std::sig_atomic_t requested = 0;

extern "C" void remember(int signal) {
  requested = signal;
}

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = remember;
  // The default action comes back after the first signal; interrupted system calls go on.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A terminal that closes ends a run like SIGTERM, unless nohup keeps it.
  struct sigaction hangup {};
  if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
  // A reader of the progress lines that goes away does not end the run.
  std::signal(SIGPIPE, SIG_IGN);
}

int requested_signal() {
  return requested;
}

}  // namespace meltray::app
