// Diagnostics as text and as JSON.
#include "renderer/app/report/report.h"

#include <nlohmann/json.hpp>

#include "renderer/app/text/print.h"

namespace marrow {

ExitCode report(const Diagnostics& diagnostics, const SourceCache& sources, ExitCode code) {
  if (!diagnostics.empty()) complain(render_all(diagnostics, sources));
  return code;
}

ExitCode report(const Diagnostics& diagnostics, ExitCode code) {
  for (const auto& diagnostic : diagnostics) complain("marrow: " + render(diagnostic, {}));
  return code;
}

std::string to_json(const Diagnostics& diagnostics) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& d : diagnostics)
    list.push_back({{"file", d.where.file},
                    {"line", d.where.line},
                    {"column", d.where.column},
                    {"length", d.length},
                    {"severity", d.severity == Severity::Error ? "error" : "warning"},
                    {"message", d.message},
                    {"hint", d.hint}});
  // Bytes that are no UTF-8 may stand in a file's name or text; they must not stop the report.
  return list.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace marrow
