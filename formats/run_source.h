// What a carved 3MF was made from, so that it can be made again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/package_record.h"

namespace fretwork {

/// A file that a run has read.
struct RunFile {
    std::string path;    ///< as the caller named it; of a model the name of its file
    std::string sha256;  ///< of its bytes; 64 hexadecimal digits
    std::string bytes;   ///< empty when the package only names it
};

struct RunSource {
    std::string version;  ///< of the program
    RunFile model;
    std::string model_format;        ///< "stl"
    std::string model_unit;          ///< of formats that name none: "millimeter"
    std::vector<RunFile> materials;  ///< of an OBJ, by the name of their file
    std::vector<RunFile> pictures;
    std::string request_toml;  ///< the settings as they were asked for, with every key
};

/// Fills in the hash of a file. \param keep  whether its bytes go into the package as well
RunFile run_file(std::string path, std::string_view bytes, bool keep);

/// `/Metadata/fretwork/run.json`, `request.toml` and, where kept, `source.EXT`, `materials1.mtl` ... and `picture1.EXT`
/// ..., as parts of a record (`package_record.h`).
std::vector<RecordPart> parts_of(const RunSource& source);

/// Whether the relationships of the package name the record of a run. \throws InvalidInput  no ZIP
bool has_run_source(std::string_view package, std::string_view name);

/// The report that lies beside it (report_json.h); empty where there is none. \throws InvalidInput  it cannot be read
std::string read_run_report(std::string_view package, std::string_view name);

/// Reads it back, by the relationships of the package.
/// \param name  of the package, for messages
/// \throws InvalidInput  no 3MF; none of Fretwork's; a part that is missing, broken or not what its hash says.
RunSource read_run_source(std::string_view package, std::string_view name);

}  // namespace fretwork
