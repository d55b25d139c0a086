// Runs the real program.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fretwork::testing {

struct ProgramResult {
    int exit_code = -1;  ///< 128 + signal where one ended it
    std::string out, err;
};

/// \param input         what the program reads from standard input
/// \param while_running  called with the process id once it runs
ProgramResult run_program(const std::vector<std::string>& arguments, const std::string& input = {},
                          const std::function<void(int)>& while_running = {});

/// A folder that is gone with this.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    [[nodiscard]] std::vector<std::string> names() const;  ///< of the files within, sorted

  private:
    std::filesystem::path path_;
};

std::string slurp(const std::string& path);
void spit(const std::string& path, const std::string& bytes);

}  // namespace fretwork::testing
