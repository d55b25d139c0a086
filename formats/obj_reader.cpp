#include "formats/obj_reader.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "formats/color_channel.h"
#include "formats/obj_materials.h"
#include "formats/parse_error.h"
#include "formats/polygon_fan.h"
#include "formats/text_scanner.h"

namespace fretwork {
namespace {

constexpr std::size_t kStopEvery = 1 << 14;

class ObjReader {
  public:
    ObjReader(std::string_view bytes, std::string_view source, const ObjMaterialFiles& files, const RunControl& run)
        : scanner_(bytes, source, {.comment = '#', .backslash_continues = true}),
          source_(source),
          files_(files),
          run_(run) {}

    MeshFile read() {
        std::size_t lines = 0;
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            if (lines++ % kStopEvery == 0) run_.throw_if_stopped();
            read_statement(word);
            scanner_.next_line();
        }
        finish();
        return std::move(file_);
    }

  private:
    void read_statement(std::string_view word) {
        if (word == "v") {
            read_vertex();
        } else if (word == "f" || word == "fo") {
            read_face();
        } else if (word == "o" || word == "g") {
            start_part();
        } else if (word == "mtllib") {
            read_libraries();
        } else if (word == "usemtl") {
            const auto known = materials_.find(scanner_.word_in_line());
            material_ = known == materials_.end() ? std::nullopt : std::optional<Rgb8>(known->second);
        } else if (word != "vt" && word != "vn" && word != "vp" && word != "s" && word != "l" && word != "p") {
            if (word.size() > 16 || skipped_.size() > 8) scanner_.fail(word, "an OBJ statement");
            skipped_.emplace(word);
        }
    }

    void read_libraries() {
        for (std::string_view name = scanner_.word_in_line(); !name.empty(); name = scanner_.word_in_line()) {
            const std::optional<std::string> bytes = files_ ? files_(name) : std::nullopt;
            if (!bytes) {
                file_.warnings.push_back("materials " + in_quotes(name) + " were not found beside the OBJ file");
                continue;
            }
            materials_.merge(read_obj_materials(*bytes, std::string(source_) + ": " + std::string(name)));
        }
    }

    void read_vertex() {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = scanner_.coordinate_in_line("a coordinate");
        std::array<double, 4> more{};
        std::size_t count = 0;
        for (std::string_view word = scanner_.word_in_line(); !word.empty() && count < more.size();
             word = scanner_.word_in_line())
            more[count++] = scanner_.to_number(word, "a number");
        // Four more numbers are a weight and a colour, three a colour, one a weight, which a polygon mesh ignores.
        const std::size_t first = count == 4 ? 1 : 0;
        if (count >= 3) {
            colors_.resize(file_.mesh.positions_mm.size(), kUncolored);
            colors_.push_back(
                {color_from_unit(more[first]), color_from_unit(more[first + 1]), color_from_unit(more[first + 2])});
        }
        file_.mesh.positions_mm.push_back(p);
    }

    void read_face() {
        corners_.clear();
        for (std::string_view word = scanner_.word_in_line(); !word.empty(); word = scanner_.word_in_line())
            corners_.push_back(vertex_of(word));
        if (corners_.size() < 3) scanner_.fail({}, "a face of at least three corners");
        const std::size_t before = file_.mesh.triangles.size();
        // A corner may name a vertex that comes later; such faces wait for it.
        if (std::ranges::all_of(corners_, [&](auto v) { return v < file_.mesh.positions_mm.size(); }) ||
            corners_.size() == 3) {
            append_polygon(file_.mesh.positions_mm, corners_, file_.mesh.triangles);
        } else {
            for (std::size_t i = 1; i + 1 < corners_.size(); ++i)
                file_.mesh.triangles.push_back({corners_[0], corners_[i], corners_[i + 1]});
        }
        if (file_.mesh.triangles.size() == before) ++empty_faces_;
        if (material_) {
            material_colors_.resize(before);
            material_colors_.resize(file_.mesh.triangles.size(), material_);
        }
    }

    std::uint32_t vertex_of(std::string_view word) {
        constexpr std::string_view kExpected = "a vertex index from 1, or a negative one from the end";
        const std::int64_t index = scanner_.to_integer(word.substr(0, word.find('/')), kExpected);
        const auto read = static_cast<std::int64_t>(file_.mesh.positions_mm.size());
        const std::int64_t vertex = index > 0 ? index - 1 : read + index;
        if (index == 0 || vertex < 0 || vertex > 0xFFFFFFFELL) scanner_.fail(word, kExpected);
        if (vertex > highest_) {
            highest_ = vertex;
            highest_line_ = scanner_.line();
        }
        return static_cast<std::uint32_t>(vertex);
    }

    void start_part() {
        close_part();
        std::string name(scanner_.word_in_line());
        for (std::string_view word = scanner_.word_in_line(); !word.empty(); word = scanner_.word_in_line())
            name.append(" ").append(word);
        file_.parts.push_back({std::move(name), static_cast<std::uint32_t>(file_.mesh.triangles.size()), 0});
    }

    void close_part() {
        const auto now = static_cast<std::uint32_t>(file_.mesh.triangles.size());
        if (file_.parts.empty()) {
            if (now > 0) file_.parts.push_back({"", 0, now});
            return;
        }
        MeshPart& last = file_.parts.back();
        last.triangle_count = now - last.first_triangle;
        if (last.triangle_count == 0) file_.parts.pop_back();
    }

    void finish() {
        if (highest_ >= static_cast<std::int64_t>(file_.mesh.positions_mm.size()))
            fail_parse(source_, place_of_line(highest_line_), "vertex index " + std::to_string(highest_ + 1),
                       "at most " + std::to_string(file_.mesh.positions_mm.size()) + ", the number of vertices");
        if (!file_.parts.empty()) close_part();
        if (!colors_.empty()) {
            colors_.resize(file_.mesh.positions_mm.size(), kUncolored);
            file_.triangle_colors = mean_of_corners(file_.mesh.triangles, colors_);
        }
        if (!material_colors_.empty()) {
            file_.triangle_colors.resize(file_.mesh.triangles.size(), kUncolored);
            for (std::size_t t = 0; t < material_colors_.size(); ++t)
                if (material_colors_[t]) file_.triangle_colors[t] = *material_colors_[t];
        }
        if (empty_faces_ > 0)
            file_.warnings.push_back(std::to_string(empty_faces_) + " faces with fewer than three different corners");
        for (const std::string& word : skipped_) file_.warnings.push_back("OBJ statements skipped: " + in_quotes(word));
    }

    TextScanner scanner_;
    std::string_view source_;
    const ObjMaterialFiles& files_;
    const RunControl& run_;
    MeshFile file_;
    std::vector<Rgb8> colors_;  ///< of vertices; shorter than the positions while the last ones have none
    std::vector<std::uint32_t> corners_;
    std::int64_t highest_ = -1;  ///< vertex named by a face, and where
    std::size_t highest_line_ = 0;
    std::size_t empty_faces_ = 0;
    std::map<std::string, Rgb8, std::less<>> materials_;
    std::optional<Rgb8> material_;                      ///< in use
    std::vector<std::optional<Rgb8>> material_colors_;  ///< of triangles; shorter while the last ones have none
    std::set<std::string> skipped_;
};

}  // namespace

MeshFile read_obj(std::string_view bytes, std::string_view source, const ObjMaterialFiles& materials,
                  const RunControl& run) {
    return ObjReader(bytes, source, materials, run).read();
}

}  // namespace fretwork
