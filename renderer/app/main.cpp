// The program: a command line becomes a command, and the command is done.
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <variant>

#include "renderer/app/command_line/commands.h"
#include "renderer/app/command_line/options.h"
#include "renderer/app/report/report.h"

namespace {

using namespace marrow;

ExitCode obey(int argc, char** argv) {
  const auto parsed = parse_options(argc, argv);
  if (const auto* finished = std::get_if<ExitCode>(&parsed)) return *finished;
  return std::visit([](const auto& command) { return run(command); }, std::get<Command>(parsed));
}

// What was printed must have arrived: a full disk is an error, not a shorter answer.
ExitCode after_flushing(ExitCode code) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  return report({failure("standard output could not be written")}, ExitCode::WriteFailed);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file larger than allowed is then a failed write, as on a full disk
  try {
    return static_cast<int>(after_flushing(obey(argc, argv)));
  } catch (const std::bad_alloc&) {
    const auto out = with_hint(failure("there is not enough memory"),
                               "a smaller picture (--crop, film.size), fewer threads or a smaller scene take less");
    return static_cast<int>(report({out}, ExitCode::Internal));
  } catch (const std::exception& error) {
    return static_cast<int>(report({failure(std::string("internal error: ") + error.what())}, ExitCode::Internal));
  }
}
