// on_all_cores.hpp  Work cut into pieces, a core for each at a time.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

namespace sinew::baker {

// Calls work(piece, done) once for each piece from 0 on, several at a time, and draws how much of `total` is
// done, which the pieces count up. Throws the first fault when all have ended; pieces that had not begun by
// then are left out.
void on_all_cores(const std::string& what, size_t total, size_t pieces,
                  const std::function<void(size_t piece, std::atomic<size_t>& done)>& work);

}  // namespace sinew::baker
