// commands.hpp  The subcommands of sinew-bake, one file each. A command throws BadInput for unusable input
// (exit 2) and sets *exit_code to 1 when a check failed.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "baker/common/command_line/input_files.hpp"
#include "pack/format.hpp"

namespace sinew::baker {

void add_creature_command(CLI::App& app, int* exit_code);
void add_character_command(CLI::App& app, int* exit_code);
void add_propose_command(CLI::App& app, int* exit_code);
void add_model_command(CLI::App& app, int* exit_code);
void add_check_command(CLI::App& app, int* exit_code);
void add_info_command(CLI::App& app, int* exit_code);
void add_truth_command(CLI::App& app, int* exit_code);
void add_patch_data_command(CLI::App& app, int* exit_code);
void add_rod_data_command(CLI::App& app, int* exit_code);
void add_judge_command(CLI::App& app, int* exit_code);
void add_audit_command(CLI::App& app, int* exit_code);

// Throws BadInput for a --precision that this version cannot bake or run.
pack::Precision parse_precision(const std::string& name);
// Throws BadInput where vectors are given that the precision has no use for.
void check_calibration(pack::Precision precision, bool given);
// --precision.
void add_precision_option(CLI::App* command, std::string* precision);

// Runs on this instruction set from here on; empty: the best, or what SINEW_ISA names. Throws BadInput where
// this processor does not have it.
void choose_isa(const std::string& name);

}  // namespace sinew::baker
