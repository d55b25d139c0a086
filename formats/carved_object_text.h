// One carved object -> what a model part says about it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/run_control.h"
#include "formats/carved_threemf_writer.h"
#include "formats/text_pieces.h"

namespace fretwork {

/// How a model part spells the namespaces that it declares (prefixes with their colon), and its unit.
struct ModelDialect {
    std::string core;  ///< empty: core is the default namespace
    std::string material = "m:";
    std::string volumetric = "v:";
    std::string own = "fw:";
    std::string slicer = "slic3rpe:";
    double units_per_mm = 1.0;
};

/// The object must outlive it, and it the pieces that it adds.
class CarvedObjectText {
  public:
    /// \param stack_suffix  set behind the names of its image stacks, so that those of several objects differ
    /// \throws InvalidInput  see check_mesh_to_write and make_voxel_sheets; no triangle. \throws Cancelled
    CarvedObjectText(const CarvedObject& object, const std::string& stack_suffix, const RunControl& run);

    /// Colour group, image stacks and volume data, each with a number from `next_id`; may be nothing.
    std::string resources(const ModelDialect& dialect, const std::function<std::uint32_t()>& next_id);

    // Valid once the resources are written; 0 where there is none.
    [[nodiscard]] std::uint32_t color_group() const { return color_group_; }
    [[nodiscard]] std::uint32_t volume() const { return volume_; }

    /// `<vertices>` and `<triangles>`. Coordinates are rounded to floats of the part's unit.
    void append_mesh(const ModelDialect& dialect, TextPieces& pieces) const;

    [[nodiscard]] const CarvedObject& object() const { return object_; }
    [[nodiscard]] bool colored() const { return !palette_.empty(); }
    [[nodiscard]] bool volumetric() const { return sheets_ != nullptr; }

    /// Path and bytes of every sheet.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> sheets() const;

  private:
    /// Functions of the volume data; 0 where there is none.
    struct Functions {
        std::uint32_t field = 0, reinforced = 0, stress = 0, label = 0;
    };
    std::uint32_t add_image(std::string& xml, const ModelDialect& dialect, const std::string& stack,
                            const VoxelGrid& grid, std::size_t sheet_count,
                            const std::function<std::uint32_t()>& next_id) const;
    static std::uint32_t add_function(std::string& xml, const ModelDialect& dialect, const std::string& name,
                                      std::uint32_t image, double scale, const std::function<std::uint32_t()>& next_id);
    [[nodiscard]] std::string volume_data(const ModelDialect& dialect, const Functions& functions) const;
    [[nodiscard]] std::string vertices(const ModelDialect& dialect, std::size_t begin) const;
    [[nodiscard]] std::string triangles(const ModelDialect& dialect, std::size_t begin) const;

    const CarvedObject& object_;
    std::vector<Rgb8> palette_;
    VoxelSheets own_sheets_;
    const VoxelSheets* sheets_ = nullptr;
    std::string field_stack_, reinforced_stack_, facts_stack_;
    std::uint32_t color_group_ = 0;
    std::uint32_t volume_ = 0;
};

}  // namespace fretwork
