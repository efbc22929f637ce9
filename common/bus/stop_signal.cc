#include "common/bus/stop_signal.h"

#include <csignal>

namespace nbs {
namespace {

std::function<void()> g_on_signal;  // Set before the handler is installed, cleared after it is removed.

volatile std::sig_atomic_t g_number = 0;

void OnSignal(int number) {
  g_number = number;
  g_on_signal();
}

void SetHandler(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

StopSignal::StopSignal(std::function<void()> on_signal) {
  g_on_signal = std::move(on_signal);
  g_number = 0;
  SetHandler(&OnSignal);
}

StopSignal::~StopSignal() { SetHandler(SIG_DFL); }

int StopSignal::number() const { return g_number; }

}  // namespace nbs
