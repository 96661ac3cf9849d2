"""Checks that the shared library shows the public API and nothing else.

usage: dynamic_symbols.py NM LIBRARY
Exit 1 with a line an offender. It first checks itself on symbols that must be refused.
"""
import re
import subprocess
import sys

# Of C++, demangled; of C, every function begins with sinew_.
PUBLIC = re.compile(r"""
    sinew_[a-z0-9_]+
  | sinew::World::(World|~World|operator=|[a-z_]+)\(.*
  | sinew::(available_isas|active_isa|force_isa)\(.*
  | (vtable\ for\ )?sinew::(ContactSource|OcclusionSource)(::.*)?
""", re.VERBOSE)
# What sinew::bullet and sinew::embree, which are libraries of their own, use of the rooms.
FOR_ADAPTERS = re.compile(r"sinew::(core::make_status|rods::nearest|simd::kernels|world::check_root)\(.*")
# All of these are there, or what was looked at is another library.
WANTED = ["sinew::World::step(", "sinew::World::create(", "sinew::force_isa("]


def is_public(symbol):
    return bool(PUBLIC.fullmatch(symbol) or FOR_ADAPTERS.fullmatch(symbol))


def symbols(nm, library):
    run = subprocess.run([nm, "-D", "-C", "--defined-only", library], capture_output=True, text=True, check=True)
    return [line.split(maxsplit=2)[2] for line in run.stdout.splitlines()]


def main(nm, library):
    for symbol in ("sinew::world::tick(int)", "std::vector<int>::~vector()", "hwy::SupportedTargets()", "sinew::World::Impl::Impl()", "_init"):
        assert not is_public(symbol), symbol
    assert is_public("sinew::World::~World()") and is_public("sinew_world_step")
    shown = symbols(nm, library)
    found = [f"{library} shows {symbol}" for symbol in shown if not is_public(symbol)]
    found += [f"{library} does not show {wanted}...)" for wanted in WANTED if not any(symbol.startswith(wanted) for symbol in shown)]
    print("\n".join(found) or f"{len(shown)} symbols, all public")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
