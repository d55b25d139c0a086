// OpenSCAD, run on a file.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "formats/scratch_folder.h"

namespace fretwork::cli {

/// What of the flags is for OpenSCAD: keys of a spec hold a dot, variables of OpenSCAD do not.
struct ScadOptions {
    std::vector<std::string> defines;  ///< NAME=VALUE as given with -D
    std::string parameter_file, parameter_set;
};

/// What one run has said and made.
struct ScadRender {
    std::string off;                 ///< the mesh; empty where the file draws nothing
    std::string error;               ///< the first; empty where all went well. Drawing nothing is one.
    std::vector<std::string> lines;  ///< of its messages
    std::set<std::string> files;     ///< that it has read, resolved

    [[nodiscard]] bool draws_nothing() const;
};

/// Renders one file in several ways, each in a run of its own. The library fretwork.scad is there to be used.
class OpenScad {
  public:
    /// \param path  of the file; "-" for `text`, which OpenSCAD then reads as if it lay in the current folder
    OpenScad(std::string path, const std::string& text, ScadOptions options);

    /// As messages name the file.
    [[nodiscard]] std::string name() const;

    /// \param wanted  value of $fretwork: "body", or "KIND:NAME" of a mark, see cli/openscad/fretwork.scad
    /// OpenSCAD reports many errors on the side and ends as if all were well; these are found.
    /// \throws FileError  OpenSCAD cannot be run. \throws Cancelled
    [[nodiscard]] ScadRender render(const std::string& wanted, const RunControl& run) const;

  private:
    std::string path_;
    ScadOptions options_;
    std::string standard_input_ = "/dev/null";
    ScratchFolder folder_;  ///< for results
};

}  // namespace fretwork::cli
