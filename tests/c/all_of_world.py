"""Checks that sinew.h has every function of sinew::World, under its name, and every one of isa.hpp.

usage: all_of_world.py PROJECT_ROOT
"""
import pathlib
import re
import sys

# Where C says it otherwise.
NAMES = {"create": "create_world", "available_isas": "isa_count", "report": "get_report", "bounds": "get_bounds",
         "asset_arrays": "get_asset_arrays", "parameters": "get_parameters", "region_parameters": "get_region_parameters",
         "rod_parameters": "get_rod_parameters", "environment": "get_environment", "added_environment": "get_added_environment"}


def name_in_c(name):
    if name.endswith("_info"):
        return "get_" + name
    return NAMES.get(name, name)


def main(root):
    include = pathlib.Path(root) / "runtime/include/sinew"
    cpp = re.sub(r"//.*", "", (include / "world.hpp").read_text() + (include / "isa.hpp").read_text())
    declared = [name for name in re.findall(r"(\w+)\([^;]*\)(?: const)? noexcept;", cpp) if name != "World"]
    c = set(re.findall(r"\bsinew_(\w+)\(", (include / "sinew.h").read_text()))
    missing = [name for name in declared if name_in_c(name) not in c]
    assert {"create", "step", "read_positions", "restore_state", "history", "joint_name", "force_isa"} <= set(declared), declared
    print("\n".join(f"World::{name} has no sinew_{name_in_c(name)} in sinew.h" for name in missing) or f"all {len(declared)} are there")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
