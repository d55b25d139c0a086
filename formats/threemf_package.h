// The container of a 3MF: which part is the model, and reading it under limits.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "formats/threemf_model.h"
#include "formats/zip_reader.h"

namespace fretwork::threemf {

class Package {
  public:
    /// The bytes must outlive it. \throws InvalidInput  see ZipReader; no model part.
    Package(std::string_view bytes, std::string_view source);

    /// Name of the start part, without a leading slash.
    [[nodiscard]] const std::string& model_part() const { return model_part_; }

    /// \param ignore_required  see ModelReader
    /// \throws InvalidInput  see ModelReader; no such part.
    [[nodiscard]] Model read_model(std::string_view part, bool ignore_required, const RunControl& run) const;

    /// A part in memory, by its path with or without a leading slash.
    [[nodiscard]] std::string read_part(std::string_view path, std::uint64_t max_bytes) const;

    [[nodiscard]] bool contains(std::string_view path) const;

    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    void find_model_part();

    std::string source_;
    ZipReader zip_;
    std::string model_part_;
    std::vector<std::string> warnings_;
};

/// "/3D/x.model" -> "3D/x.model"
[[nodiscard]] std::string_view without_slash(std::string_view path);

}  // namespace fretwork::threemf
