// input_files.hpp  What a command line reads and writes: no output may take the place of an input.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "baker/common/files/kept_files.hpp"

namespace sinew::baker {

inline constexpr const char* kOutputs = "Writes";  // the heading that --help lists outputs under

inline CLI::Option* add_output(CLI::App& app, const std::string& names, std::string& path,
                               const std::string& what) {
  return app.add_option(names, path, what)->group(kOutputs);
}

template <class Work>
void for_each_value(const CLI::App& app, bool of_outputs, Work work) {
  for (const CLI::Option* option : app.get_options())
    if ((option->get_group() == kOutputs) == of_outputs)
      for (const std::string& value : option->results()) work(value);
  for (const CLI::App* command : app.get_subcommands()) for_each_value(*command, of_outputs, work);
}

// Before the work that was asked for: every file that an option names is an input, but for those of
// add_output. Throws BadInput as promise_file does.
inline void keep_inputs(CLI::App& app) {
  app.parse_complete_callback([&app] {
    for_each_value(app, false, keep_file);
    for_each_value(app, true, promise_file);
  });
}

}  // namespace sinew::baker
