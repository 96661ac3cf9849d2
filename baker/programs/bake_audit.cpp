// bake_audit.cpp  sinew-bake audit: plays a baked character and says where it looks broken.
#include <cstdio>
#include <memory>

#include "baker/audit/audit.hpp"
#include "baker/audit/describe_audit.hpp"
#include "baker/audit/sheet.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/common/progress.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/programs/commands.hpp"

namespace sinew::baker {
namespace {

struct AuditOptions {
  std::string character, sheet;
  bool json = false;
};

int run(const AuditOptions& options) {
  if (!options.sheet.empty()) refuse_directory(options.sheet);
  const LoadedPack loaded = LoadedPack::from_file(options.character);
  const AuditedPack pack{loaded.view(), loaded.bytes()};
  if (pack.view.character == nullptr)
    throw BadInput(options.character +
                   ": is a model without a character; bake one with: sinew-bake character IN.glb -o C.sinew");
  Audit audit;
  {
    Progress progress("auditing " + options.character, 100);
    audit = run_audit(
        pack, [&](size_t done, size_t all) { progress.update(100 * done / std::max<size_t>(1, all)); });
  }
  if (options.json) {
    std::printf(
        "%s\n",
        audit_json(audit, pack).dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    std::printf("%s", audit_table(audit, pack).c_str());
    for (const std::string& failure : audit.failures) std::printf("FAILED: %s\n", failure.c_str());
    if (audit.failures.empty()) std::printf("within all bounds\n");
  }
  if (!options.sheet.empty()) write_audit_sheet(options.sheet, audit, pack);
  return audit.failures.empty() ? 0 : 1;
}

}  // namespace

void add_audit_command(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* command = app.add_subcommand(
      "audit", "Plays a character's clips and standard motions; exit code 1 where it looks broken");
  command->add_option("character", options->character, "C.sinew")->required();
  command->add_flag("--json", options->json, "machine-readable");
  add_output(*command, "-o,--output", options->sheet, "contact sheet of the worst moments, .png");
  command->callback([options, exit_code] { *exit_code = run(*options); });
}

}  // namespace sinew::baker
