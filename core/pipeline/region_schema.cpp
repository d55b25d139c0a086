#include "core/pipeline/region_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/words.h"
#include "core/pipeline/object_settings.h"
#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

// Reads the entries of one table, remembering which were used.
class TableReader {
  public:
    explicit TableReader(const SettingTable& table) : table_(table), used_(table.entries.size(), false) {}

    std::optional<std::string> text(std::string_view key) {
        const SettingAssignment* entry = take(key);
        if (!entry) return std::nullopt;
        if (const auto* value = std::get_if<std::string>(&entry->value)) return *value;
        fail(*entry, "expected text");
    }

    /// `count` numbers; 0 for any number of them.
    std::optional<std::vector<double>> numbers(std::string_view key, int count) {
        const SettingAssignment* entry = take(key);
        if (!entry) return std::nullopt;
        std::vector<double> list;
        if (const auto* integer = std::get_if<std::int64_t>(&entry->value))
            list = {static_cast<double>(*integer)};
        else if (const auto* real = std::get_if<double>(&entry->value))
            list = {*real};
        else if (const auto* many = std::get_if<std::vector<double>>(&entry->value))
            list = *many;
        const bool finite = std::ranges::all_of(list, [](double x) { return std::isfinite(x); });
        if (list.empty() || !finite || (count != 0 && list.size() != static_cast<std::size_t>(count)))
            fail(*entry, count == 1   ? "expected a number"
                         : count == 0 ? "expected a list of numbers"
                                      : fmt::format("expected a list of {} numbers", count));
        return list;
    }

    std::vector<double> required(std::string_view key, int count, std::string_view shape) {
        if (auto list = numbers(key, count)) return *std::move(list);
        throw InvalidSetting(fmt::format("{}: a region of shape '{}' needs '{}'", where(), shape, key));
    }

    void nothing_left(std::span<const std::string> known) const {
        for (std::size_t i = 0; i < used_.size(); ++i)
            if (!used_[i])
                throw InvalidSetting(fmt::format("{}: unknown key '{}' in [[{}]]; did you mean '{}'?",
                                                 place(table_.entries[i]), table_.entries[i].key, table_.array,
                                                 nearest_name(table_.entries[i].key, known)));
    }

    [[nodiscard]] std::string where() const {
        return table_.place.empty() ? fmt::format("[[{}]]", table_.array)
                                    : fmt::format("{}: [[{}]]", table_.place, table_.array);
    }

  private:
    const SettingAssignment* take(std::string_view key) {
        for (std::size_t i = 0; i < used_.size(); ++i)
            if (table_.entries[i].key == key) {
                used_[i] = true;
                return &table_.entries[i];
            }
        return nullptr;
    }
    [[nodiscard]] std::string place(const SettingAssignment& entry) const {
        return entry.place.empty() ? where() : entry.place;
    }
    [[noreturn]] void fail(const SettingAssignment& entry, const std::string& expected) const {
        throw InvalidSetting(
            fmt::format("{}: {} = {}: {}", place(entry), entry.key, setting_text(entry.value), expected));
    }

    const SettingTable& table_;
    std::vector<bool> used_;
};

Vec3 vec(const std::vector<double>& list) {
    return Vec3(list[0], list[1], list[2]);
}
std::vector<double> list(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

double positive(double value, std::string_view key, const TableReader& in) {
    if (value > 0) return value;
    throw InvalidSetting(fmt::format("{}: {} = {:g}: expected a number above 0", in.where(), key, value));
}

Vec3 direction(const Vec3& value, std::string_view key, const TableReader& in) {
    if (value.norm() > 0) return value;
    throw InvalidSetting(fmt::format("{}: {}: expected a direction that is not zero", in.where(), key));
}

BoxRegion read_box(TableReader& in) {
    const Vec3 min = vec(in.required("min_mm", 3, "box")), max = vec(in.required("max_mm", 3, "box"));
    if ((max - min).minCoeff() <= 0)
        throw InvalidSetting(in.where() + ": max_mm must be above min_mm along every axis");
    return {min, max};
}

TriangleSetRegion read_triangles(TableReader& in) {
    TriangleSetRegion region;
    for (const double index : in.required("triangles", 0, "triangles")) {
        if (index < 0 || index > std::numeric_limits<std::uint32_t>::max() || index != std::floor(index))
            throw InvalidSetting(fmt::format("{}: triangles: {:g} is not the number of a triangle", in.where(), index));
        region.triangles.push_back(static_cast<std::uint32_t>(index));
    }
    return region;
}

/// Numbers in groups of three.
std::vector<double> triples(TableReader& in, std::string_view key) {
    std::vector<double> list = in.required(key, 0, "volume");
    if (list.size() % 3 != 0)
        throw InvalidSetting(
            fmt::format("{}: {}: expected three numbers for each, found {} numbers", in.where(), key, list.size()));
    return list;
}

VolumeRegion read_volume(TableReader& in) {
    VolumeRegion region;
    const std::vector<double> vertices = triples(in, "vertices"), corners = triples(in, "corners");
    for (std::size_t i = 0; i < vertices.size(); i += 3)
        region.surface.positions_mm.emplace_back(vertices[i], vertices[i + 1], vertices[i + 2]);
    const std::size_t count = region.surface.positions_mm.size();
    for (const double index : corners)
        if (index < 0 || index >= static_cast<double>(count) || index != std::floor(index))
            throw InvalidSetting(
                fmt::format("{}: corners: {:g} is not the number of one of the {} vertices", in.where(), index, count));
    for (std::size_t i = 0; i < corners.size(); i += 3)
        region.surface.triangles.push_back({static_cast<std::uint32_t>(corners[i]),
                                            static_cast<std::uint32_t>(corners[i + 1]),
                                            static_cast<std::uint32_t>(corners[i + 2])});
    return region;
}

NamedRegion read_names(TableReader& in) {
    NamedRegion region{words_between_commas(in.text("names").value_or(std::string{}))};
    if (region.names.empty())
        throw InvalidSetting(in.where() + ": a region of shape 'named' needs 'names', such as \"Face1, Face2\"");
    return region;
}

Region read_region(TableReader& in) {
    Region region;
    region.name = in.text("name").value_or(std::string{});
    const std::string shape = in.text("shape").value_or(std::string{});
    const auto width = [&](std::string_view key) { return positive(in.required(key, 1, shape)[0], key, in); };
    const auto point = [&](std::string_view key) { return vec(in.required(key, 3, shape)); };
    const auto normal = [&](std::string_view key) { return direction(point(key), key, in); };
    if (shape == "box")
        region.shape = read_box(in);
    else if (shape == "sphere")
        region.shape = SphereRegion{point("center_mm"), width("radius_mm")};
    else if (shape == "cylinder")
        region.shape = CylinderRegion{point("from_mm"), point("to_mm"), width("radius_mm")};
    else if (shape == "half_space")
        region.shape = HalfSpaceRegion{point("point_mm"), normal("outward")};
    else if (shape == "plane_band")
        region.shape = PlaneBandRegion{point("point_mm"), normal("normal"), width("half_width_mm")};
    else if (shape == "sharp_edges")
        region.shape = SharpEdgeRegion{width("min_angle_deg"), width("half_width_mm")};
    else if (shape == "open_border")
        region.shape = OpenBorderRegion{width("half_width_mm")};
    else if (shape == "triangles")
        region.shape = read_triangles(in);
    else if (shape == "named")
        region.shape = read_names(in);
    else if (shape == "lowest") {
        const double share = width("share");
        if (share > 1) throw InvalidSetting(fmt::format("{}: share = {:g}: expected at most 1", in.where(), share));
        region.shape = LowestRegion{share};
    } else if (shape == "everywhere")
        region.shape = EverywhereRegion{};
    else if (shape == "volume")
        region.shape = read_volume(in);
    else {
        std::vector<std::string> known;
        for (const RegionShapeInfo& info : region_shapes()) known.push_back(info.shape);
        throw InvalidSetting(shape.empty()
                                 ? fmt::format("{}: needs 'shape', one of {}", in.where(), fmt::join(known, ", "))
                                 : fmt::format("{}: unknown shape '{}'; did you mean '{}'?", in.where(), shape,
                                               nearest_name(shape, known)));
    }
    return region;
}

std::vector<std::string> known_keys(const TableInfo& info, const Region& region) {
    std::vector<std::string> known = {"name", "shape"};
    for (const RegionKeyInfo& key : info.numbers) known.push_back(key.key);
    for (const RegionKeyInfo& key : info.texts) known.push_back(key.key);
    const RegionShapeInfo& shape = region_shapes()[region.shape.index()];
    for (const auto* list : {&shape.keys, &shape.texts})
        for (const RegionKeyInfo& key : *list) known.push_back(key.key);
    return known;
}

const TableInfo& table_info(const SettingTable& table) {
    const auto infos = table_infos();
    const auto found = std::ranges::find(infos, table.array, &TableInfo::array);
    if (found != infos.end()) return *found;
    std::vector<std::string> known;
    for (const TableInfo& info : infos) known.push_back(info.array);
    known.emplace_back(kObjectArray);
    throw InvalidSetting(fmt::format("{}{}unknown table [[{}]]; did you mean [[{}]]?", table.place,
                                     table.place.empty() ? "" : ": ", table.array, nearest_name(table.array, known)));
}

// --- back to tables -------------------------------------------------------------------------------

struct ShapeWriter {
    std::vector<SettingAssignment>& out;
    void put(const char* key, SettingValue value) const { out.push_back({key, std::move(value), {}}); }

    void operator()(const BoxRegion& r) const { put("min_mm", list(r.min_mm)), put("max_mm", list(r.max_mm)); }
    void operator()(const SphereRegion& r) const { put("center_mm", list(r.center_mm)), put("radius_mm", r.radius_mm); }
    void operator()(const CylinderRegion& r) const {
        put("from_mm", list(r.from_mm)), put("to_mm", list(r.to_mm)), put("radius_mm", r.radius_mm);
    }
    void operator()(const HalfSpaceRegion& r) const {
        put("point_mm", list(r.point_mm)), put("outward", list(r.outward));
    }
    void operator()(const PlaneBandRegion& r) const {
        put("point_mm", list(r.point_mm)), put("normal", list(r.normal)), put("half_width_mm", r.half_width_mm);
    }
    void operator()(const SharpEdgeRegion& r) const {
        put("min_angle_deg", r.min_angle_deg), put("half_width_mm", r.half_width_mm);
    }
    void operator()(const OpenBorderRegion& r) const { put("half_width_mm", r.half_width_mm); }
    void operator()(const TriangleSetRegion& r) const {
        put("triangles", std::vector<double>(r.triangles.begin(), r.triangles.end()));
    }
    void operator()(const NamedRegion& r) const { put("names", fmt::format("{}", fmt::join(r.names, ", "))); }
    void operator()(const LowestRegion& r) const { put("share", r.share); }
    void operator()(const EverywhereRegion&) const {}
    void operator()(const VolumeRegion& r) const {
        std::vector<double> vertices, corners;
        for (const Vec3& p : r.surface.positions_mm) vertices.insert(vertices.end(), {p[0], p[1], p[2]});
        for (const Triangle& t : r.surface.triangles)
            for (const std::uint32_t v : t) corners.push_back(v);
        put("vertices", std::move(vertices)), put("corners", std::move(corners));
    }
};

SettingTable table_from(const char* array, const Region& region) {
    SettingTable table{array, {}, {}};
    if (!region.name.empty()) table.entries.push_back({"name", region.name, {}});
    table.entries.push_back({"shape", region_shapes()[region.shape.index()].shape, {}});
    std::visit(ShapeWriter{table.entries}, region.shape);
    return table;
}

}  // namespace

std::span<const RegionShapeInfo> region_shapes() {
    // In the order of the variant in Region, which names them by index.
    static const std::vector<RegionShapeInfo> shapes = {
        {"box",
         "An upright box.",
         {{"min_mm", 3, "Its lowest corner, mm."}, {"max_mm", 3, "Its highest corner, mm."}},
         "min_mm = [0, 0, 0], max_mm = [20, 20, 5]"},
        {"sphere",
         "A ball.",
         {{"center_mm", 3, "Its centre, mm."}, {"radius_mm", 1, "Its radius, above 0 mm."}},
         "center_mm = [0, 0, 40], radius_mm = 8"},
        {"cylinder",
         "A cylinder with flat ends.",
         {{"from_mm", 3, "Centre of one end, mm."},
          {"to_mm", 3, "Centre of the other end, mm."},
          {"radius_mm", 1, "Its radius, above 0 mm."}},
         "from_mm = [0, 0, 0], to_mm = [0, 0, 50], radius_mm = 6"},
        {"half_space",
         "Everything on one side of a plane.",
         {{"point_mm", 3, "A point on the plane, mm."}, {"outward", 3, "Direction that points out of the region."}},
         "point_mm = [0, 0, 5], outward = [0, 0, 1]"},
        {"plane_band",
         "What lies close to a plane.",
         {{"point_mm", 3, "A point on the plane, mm."},
          {"normal", 3, "The plane's normal."},
          {"half_width_mm", 1, "Distance to each side, above 0 mm."}},
         "point_mm = [0, 0, 30], normal = [0, 0, 1], half_width_mm = 2"},
        {"sharp_edges",
         "What lies close to the model's sharp edges.",
         {{"min_angle_deg", 1, "Edges folded by more than this count as sharp, above 0 degrees."},
          {"half_width_mm", 1, "Distance from the edge, above 0 mm."}},
         "min_angle_deg = 40, half_width_mm = 2"},
        {"open_border",
         "What lies close to the open borders of the surface.",
         {{"half_width_mm", 1, "Distance from the border, above 0 mm."}},
         "half_width_mm = 2"},
        {"triangles",
         "Triangles of the model by number.",
         {{"triangles", 0, "Their numbers in the file, counted from 0."}},
         "triangles = [0, 1, 2]"},
        {"named",
         "Faces of a CAD model, parts or objects of a file, by name.",
         {},
         "names = \"Face3, Face12\"",
         {{"names", 1, "Names, with commas between them."}}},
        {"lowest",
         "The lowest part of the model.",
         {{"share", 1, "Of the height, above 0 and up to 1."}},
         "share = 0.05"},
        {"everywhere", "The whole surface.", {}, ""},
        {"volume",
         "What a closed surface encloses, in the coordinates of the model's file; marks in OpenSCAD files become "
         "these.",
         {{"vertices", 0, "x, y, z of one vertex after the other."},
          {"corners", 0, "Three numbers of vertices for each triangle, counted from 0."}},
         "vertices = [0, 0, 0, 9, 0, 0, 0, 9, 0, 0, 0, 9], corners = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]"},
    };
    return shapes;
}

std::span<const TableInfo> table_infos() {
    static const std::vector<TableInfo> infos = {
        {"keep", "A region that stays solid.", {}, {}},
        {"carve", "With any of these, only they are carved; all else stays solid.", {}, {}},
        {"loads",
         "A region that is pushed.",
         {{"force_n", 3, "Total force over the region, N."},
          {"pressure_mpa", 1, "Pressure into the surface, MPa."},
          {"normal_force_n", 1, "The same as a force: pressure times the region's area, N."}},
         {{"case", 1, "Loads of one case act together; other cases are looked at on their own."}}},
        {"fixtures", "A region that cannot move.", {}, {{"case", 1, "The only load case it holds in."}}},
    };
    return infos;
}

void apply_table(Settings& settings, const SettingTable& table) {
    if (table.array == kObjectArray) {
        settings.objects.push_back(object_option_from(table));
        return;
    }
    const TableInfo& info = table_info(table);
    TableReader in(table);
    Region region = read_region(in);
    if (table.array == "keep")
        settings.keep.push_back(region);
    else if (table.array == "carve")
        settings.carve.push_back(region);
    else if (table.array == "fixtures")
        settings.fixtures.push_back({region, in.text("case").value_or(std::string{})});
    else {
        LoadOption load;
        load.load_case = in.text("case").value_or(load.load_case);
        if (const auto force = in.numbers("force_n", 3)) load.force_n = vec(*force);
        if (const auto pressure = in.numbers("pressure_mpa", 1)) load.pressure_mpa = (*pressure)[0];
        if (const auto force = in.numbers("normal_force_n", 1)) load.normal_force_n = (*force)[0];
        if (load.force_n.norm() <= 0 && load.pressure_mpa == 0 && load.normal_force_n == 0)
            throw InvalidSetting(in.where() + ": needs force_n, pressure_mpa or normal_force_n");
        load.region = region;
        settings.loads.push_back(std::move(load));
    }
    in.nothing_left(known_keys(info, region));
}

std::vector<SettingTable> tables_from(const Settings& settings) {
    std::vector<SettingTable> tables;
    for (const Region& region : settings.keep) tables.push_back(table_from("keep", region));
    for (const Region& region : settings.carve) tables.push_back(table_from("carve", region));
    for (const LoadOption& load : settings.loads) {
        SettingTable table = table_from("loads", load.region);
        table.entries.push_back({"case", load.load_case, {}});
        table.entries.push_back({"force_n", list(load.force_n), {}});
        table.entries.push_back({"pressure_mpa", load.pressure_mpa, {}});
        table.entries.push_back({"normal_force_n", load.normal_force_n, {}});
        tables.push_back(std::move(table));
    }
    for (const FixtureOption& fixture : settings.fixtures) {
        SettingTable table = table_from("fixtures", fixture.region);
        if (!fixture.load_case.empty()) table.entries.push_back({"case", fixture.load_case, {}});
        tables.push_back(std::move(table));
    }
    for (const ObjectOption& option : settings.objects) tables.push_back(table_from(option));
    return tables;
}

}  // namespace fretwork
