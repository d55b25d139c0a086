// The pictures that a run reads, each once, and the exemplar made of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/pipeline/choose_exemplar.h"
#include "formats/run_source.h"

namespace fretwork::cli {

class PictureFiles {
  public:
    PictureFiles() = default;

    /// \param earlier  what an earlier run has read: taken from there, or if only named there then from the disk
    explicit PictureFiles(std::vector<RunFile> earlier) : earlier_(std::move(earlier)) {}

    /// The bytes of a picture; valid until the next call.
    /// \throws FileError  cannot be opened. \throws InvalidInput  not the picture that the earlier run has read.
    const std::string& bytes_of(const std::string& path);

    /// What `make` makes of the options; the last one is kept for whoever asks for the same. Valid until the next call.
    const ChosenExemplar& exemplar(const ExemplarOptions& options, const std::function<ChosenExemplar()>& make);

    /// What was read, in that order. \param keep  see run_file
    [[nodiscard]] std::vector<RunFile> files(bool keep) const;

  private:
    std::vector<RunFile> earlier_;
    std::vector<std::pair<std::string, std::string>> read_;  ///< path and bytes
    std::optional<std::pair<ExemplarOptions, ChosenExemplar>> made_;
};

}  // namespace fretwork::cli
