// Model part of a 3MF package (XML) -> Model.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/base/run_control.h"
#include "formats/threemf_materials.h"
#include "formats/threemf_model.h"

namespace fretwork::threemf {

struct ModelReadOptions {
    bool ignore_required = false;  ///< an unknown required extension is a warning
    ReadPart read_part;            ///< for textures; may be empty: they have no colour then
};

/// Takes the part block by block; vertices and triangles that stand plainly are taken past the XML reader, several
/// times faster. Understands core, materials, production (paths) and
/// image stacks of the volumetric extension; ignores what it does not know, unless the model requires
/// it.
class ModelReader {
  public:
    ModelReader(std::string_view source, const ModelReadOptions& options, const RunControl& run);
    ~ModelReader();

    /// \throws InvalidInput  naming the line: XML that is not well-formed; an unknown required
    ///     extension; an id, index or number that is malformed, out of range or not finite; a repeated
    ///     id; a singular transform; more than 65536 resources, components, items or metadata.
    /// \throws Cancelled
    void feed(std::string_view block);

    /// Call once, last.
    Model finish();

  private:
    class Handler;

    std::unique_ptr<Handler> handler_;
    std::string rest_;  ///< a tag that is not whole yet
};

/// A whole part in memory.
Model read_model(std::string_view xml, std::string_view source, const RunControl& run = {});

}  // namespace fretwork::threemf
