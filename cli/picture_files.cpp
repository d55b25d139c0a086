#include "cli/picture_files.h"

#include <algorithm>

#include "core/base/error.h"
#include "formats/read_file.h"

namespace fretwork::cli {

const std::string& PictureFiles::bytes_of(const std::string& path) {
    const auto known = std::ranges::find(read_, path, [](const auto& entry) { return entry.first; });
    if (known != read_.end()) return known->second;
    const auto before = std::ranges::find(earlier_, path, &RunFile::path);
    std::string bytes = before != earlier_.end() ? before->bytes : std::string{};
    if (bytes.empty()) bytes = read_file(std::filesystem::path(path));
    if (before != earlier_.end() && run_file(path, bytes, false).sha256 != before->sha256)
        throw InvalidInput(path + ": found another picture than was carved with, expected SHA-256 " + before->sha256);
    return read_.emplace_back(path, std::move(bytes)).second;
}

const ChosenExemplar& PictureFiles::exemplar(const ExemplarOptions& options,
                                             const std::function<ChosenExemplar()>& make) {
    if (!made_ || made_->first != options) made_.emplace(options, make());
    return made_->second;
}

std::vector<RunFile> PictureFiles::files(bool keep) const {
    std::vector<RunFile> files;
    for (const auto& [path, bytes] : read_) files.push_back(run_file(path, bytes, keep));
    return files;
}

}  // namespace fretwork::cli
