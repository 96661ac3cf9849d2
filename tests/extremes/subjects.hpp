// subjects.hpp  Packs that the tests make themselves, of each kind of character.
#pragma once
#include <memory>
#include <vector>

#include "tests/extremes/act.hpp"

namespace sinew::extremes {

// Made once a process; used by one thread at a time.
const std::vector<std::unique_ptr<Subject>>& built_subjects();

}  // namespace sinew::extremes
