#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <vector>

#include "cli/calibration_cache.h"
#include "cli/paths.h"
#include "cli/run_cli.h"
#include "cli/wiring.h"

namespace {

// A signal handler can reach nothing but a global.
vitruvian::Execution interrupt_switch(1);

extern "C" void on_interrupt(int) { interrupt_switch.cancel(); }

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  // The second signal ends the process at once.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A reader of --json that goes away is an error of writing, not a death.
  std::signal(SIGPIPE, SIG_IGN);
}

std::string program_folder(const char* called_as) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (error ? std::filesystem::absolute(called_as) : self).parent_path().string();
}

}  // namespace

int main(int count, char** values) {
  catch_interrupts();
  const std::vector<std::string> arguments(values + 1, values + count);
  const char* data = std::getenv("VITRUVIAN_DATA");
  const std::vector<std::string> folders =
      vitruvian::data_folders(program_folder(values[0]), data ? data : "");
  const std::string cache = vitruvian::cache_folder(std::getenv("XDG_CACHE_HOME"), std::getenv("HOME"));
  const vitruvian::CliContext context{std::cout,
                                      std::cerr,
                                      isatty(STDERR_FILENO) == 1,
                                      interrupt_switch,
                                      vitruvian::native_register(folders, cache),
                                      vitruvian::native_body(folders)};
  return static_cast<int>(vitruvian::run_cli(arguments, context));
}
