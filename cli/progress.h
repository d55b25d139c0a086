// Progress on stderr: one line that is drawn over, or one JSON object per line.
#pragma once

#include <stop_token>
#include <string>

#include "core/base/run_control.h"

namespace fretwork::cli {

enum class ProgressStyle {
    kAuto,  ///< a bar when stderr is a terminal, else nothing
    kNone,
    kJson,  ///< {"stage": "solidify", "fraction": 0.53}
};

/// \throws CLI::ValidationError  other than auto, none, json
ProgressStyle progress_style(const std::string& name);

/// A RunControl that shows its progress. Clears the bar's line when the last copy goes.
RunControl shown_progress(ProgressStyle style, std::stop_token stop);

}  // namespace fretwork::cli
