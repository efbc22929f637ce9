#include "common/bus/stop_signal.h"

#include <csignal>

namespace nbs {
namespace {

std::function<void()> g_on_signal;  // Set before the handler is installed, cleared after it is removed.

void OnSignal(int) { g_on_signal(); }

void SetHandler(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

StopSignal::StopSignal(std::function<void()> on_signal) {
  g_on_signal = std::move(on_signal);
  SetHandler(&OnSignal);
}

StopSignal::~StopSignal() { SetHandler(SIG_DFL); }

}  // namespace nbs
