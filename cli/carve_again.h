// `carve OUT.3mf --again`: what a carved 3MF says about its own making.
#pragma once

#include <string>

#include "cli/files.h"
#include "cli/pattern_options.h"
#include "cli/picture_files.h"

namespace fretwork::cli {

struct CarveRequest {
    ModelBytes model;
    PictureFiles pictures;
    Settings settings;
    std::vector<std::string> warnings;
    std::vector<std::string> sources;  ///< files of the model that were read beside a package
};

/// The model, pictures and settings of a record. \see request_of_package
CarveRequest request_of_run(RunSource run, const std::string& package, const std::string& source,
                            const PatternOptions& pattern);

/// The model, pictures and settings that the package keeps. Flags of `pattern` come on top.
/// \param source  path of the model, needed where the package only names it; empty: none
/// \throws InvalidInput    see read_run_source; a model or picture other than the one that was carved.
/// \throws InvalidSetting  the model is not in the package and `source` is not given; a spec among the flags.
CarveRequest request_of_package(const ModelBytes& package, const std::string& source, const PatternOptions& pattern);

}  // namespace fretwork::cli
