// kept_files.hpp  Files of this process that must not be written over: its inputs. One process is one run, so
// the list is the process's. Not thread-safe: programs read and write on their first thread.
#pragma once
#include <string>

namespace sinew::baker {

// Throws BadInput where the file is one that this run is to write.
void keep_file(const std::string& path);
// Says that the file will be written. Throws BadInput where it is kept, or was said before.
void promise_file(const std::string& path);
// Throws BadInput where the file is kept: "X is the input; give another name". Compared as files, so that
// links and other spellings of a path are the same.
void refuse_over_kept(const std::string& path);

}  // namespace sinew::baker
