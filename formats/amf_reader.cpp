#include "formats/amf_reader.h"

#include <algorithm>
#include <set>
#include <string>

#include "formats/amf_document.h"
#include "formats/color_channel.h"
#include "formats/parse_error.h"
#include "formats/zip_reader.h"

namespace fretwork {
namespace {

constexpr std::size_t kMaxDepth = 8;
constexpr std::size_t kMaxPlaced = 16384;
constexpr std::size_t kFreeTriangles = 4 << 20;
constexpr std::uint64_t kMaxDocumentBytes = std::uint64_t{4} << 30;

/// Triangle, vertices, volume, object, material: the first that says something.
class ObjectColors {
  public:
    ObjectColors(const amf::Document& document, const amf::Object& object) : document_(document), object_(object) {}

    [[nodiscard]] std::vector<Rgb8> of_triangles() const {
        std::vector<Rgb8> colors(object_.mesh.triangles.size(), kUncolored);
        for (const amf::Volume& volume : object_.volumes)
            std::fill_n(colors.begin() + volume.first_triangle, volume.triangle_count, of_volume(volume));
        if (!object_.vertex_colors.empty()) blend_corners(colors);
        for (std::size_t t = 0; t < object_.triangle_colors.size(); ++t)
            if (object_.triangle_colors[t]) colors[t] = *object_.triangle_colors[t];
        return colors;
    }

    [[nodiscard]] bool any() const {
        const auto colored = [&](const amf::Volume& v) { return v.color || document_.materials.contains(v.material); };
        return object_.color || !object_.vertex_colors.empty() || !object_.triangle_colors.empty() ||
               std::ranges::any_of(object_.volumes, colored);
    }

  private:
    [[nodiscard]] Rgb8 of_volume(const amf::Volume& volume) const {
        if (volume.color) return *volume.color;
        if (object_.color) return *object_.color;
        const auto material = document_.materials.find(volume.material);
        return material == document_.materials.end() ? kUncolored : material->second;
    }

    /// Triangles with a coloured corner take the mean of their corners.
    void blend_corners(std::vector<Rgb8>& colors) const {
        for (std::size_t t = 0; t < colors.size(); ++t) {
            std::array<unsigned, 3> sum{};
            bool touched = false;
            for (const std::uint32_t v : object_.mesh.triangles[t]) {
                const bool own = v < object_.vertex_colors.size() && object_.vertex_colors[v].has_value();
                touched = touched || own;
                const Rgb8& corner = own ? *object_.vertex_colors[v] : colors[t];
                for (std::size_t k = 0; k < 3; ++k) sum[k] += corner[k];
            }
            if (!touched) continue;
            for (std::size_t k = 0; k < 3; ++k) colors[t][k] = static_cast<std::uint8_t>((sum[k] + 1) / 3);
        }
    }

    const amf::Document& document_;
    const amf::Object& object_;
};

class Placer {
  public:
    Placer(const amf::Document& document, std::string_view source, const RunControl& run)
        : document_(document), source_(source), run_(run) {
        for (const auto& [id, object] : document.objects) stored_triangles_ += object.mesh.triangles.size();
    }

    MeshFile place_all() {
        std::set<std::string> held;
        for (const auto& [id, instances] : document_.constellations)
            for (const amf::Instance& instance : instances) held.insert(instance.target);
        bool placed = false;
        for (const auto& [id, instances] : document_.constellations) {
            if (held.contains(id)) continue;
            place_constellation(instances, Eigen::Affine3d::Identity(), 1);
            placed = true;
        }
        if (!placed && !document_.constellations.empty())
            fail_parse(source_, "constellations", "constellations that hold each other", "no cycle");
        if (!placed)
            for (const std::string& id : document_.order)
                place_object(document_.objects.at(id), Eigen::Affine3d::Identity(), 0);
        finish();
        return std::move(file_);
    }

  private:
    void place_constellation(const std::vector<amf::Instance>& instances, const Eigen::Affine3d& outer,
                             std::size_t depth) {
        for (const amf::Instance& instance : instances) {
            // Also those that lead to nothing: a tree of them costs time all the same.
            if (++placed_ > kMaxPlaced)
                fail_parse(source_, place_of_line(instance.line), "over 16384 placed instances", "fewer");
            if (depth > kMaxDepth)
                fail_parse(source_, place_of_line(instance.line), "constellations over 8 levels deep", "fewer");
            const Eigen::Affine3d transform = outer * instance.transform;
            const auto object = document_.objects.find(instance.target);
            if (object != document_.objects.end()) {
                place_object(object->second, transform, instance.line);
                continue;
            }
            const auto constellation = document_.constellations.find(instance.target);
            if (constellation == document_.constellations.end())
                fail_parse(source_, place_of_line(instance.line), "objectid " + in_quotes(instance.target),
                           "an object or constellation of the document");
            place_constellation(constellation->second, transform, depth + 1);
        }
    }

    void place_object(const amf::Object& object, const Eigen::Affine3d& transform, std::size_t line) {
        run_.throw_if_stopped();
        TriangleMesh& mesh = file_.mesh;
        const std::size_t most = std::max(kFreeTriangles, 2 * stored_triangles_);
        if (mesh.triangles.size() + object.mesh.triangles.size() > most)
            fail_parse(source_, place_of_line(line), "more placed triangles than " + std::to_string(most), "fewer");
        const auto base = static_cast<std::uint32_t>(mesh.positions_mm.size());
        const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
        for (const Vec3& p : object.mesh.positions_mm) mesh.positions_mm.push_back(transform * p);
        for (const Triangle& t : object.mesh.triangles)
            mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        for (const amf::Volume& volume : object.volumes)
            if (volume.triangle_count > 0)
                file_.parts.push_back({volume.name.empty() ? object.name : volume.name, first + volume.first_triangle,
                                       volume.triangle_count});
        const ObjectColors colors(document_, object);
        if (!colors.any()) return;
        file_.triangle_colors.resize(first, kUncolored);
        const std::vector<Rgb8> own = colors.of_triangles();
        file_.triangle_colors.insert(file_.triangle_colors.end(), own.begin(), own.end());
    }

    void finish() {
        file_.unit = document_.unit;
        file_.warnings = document_.warnings;
        for (Vec3& p : file_.mesh.positions_mm) {
            p *= millimeters_per(document_.unit);
            if (!(p.cwiseAbs().maxCoeff() <= kMaxCoordinate))
                fail_parse(source_, "placed objects", "a coordinate over 1e9 mm in size", "a smaller one");
        }
        if (!file_.triangle_colors.empty()) file_.triangle_colors.resize(file_.mesh.triangles.size(), kUncolored);
    }

    const amf::Document& document_;
    std::string source_;
    const RunControl& run_;
    std::size_t stored_triangles_ = 0;
    std::size_t placed_ = 0;  ///< instances, of objects and of constellations
    MeshFile file_;
};

}  // namespace

MeshFile read_amf(std::string_view bytes, std::string_view source, const RunControl& run) {
    if (!bytes.starts_with("PK")) return Placer(amf::read_document(bytes, source, run), source, run).place_all();
    const ZipReader zip(bytes, source);
    if (zip.entries().size() != 1)
        fail_parse(source, "packed AMF", std::to_string(zip.entries().size()) + " parts", "one");
    const std::string document = zip.read(zip.entries().front().name, kMaxDocumentBytes);
    return Placer(amf::read_document(document, source, run), source, run).place_all();
}

}  // namespace fretwork
