// CAD models in: closed, outward and as large as they are drawn.
#include "formats/cad_reader.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <IGESControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <catch2/catch.hpp>
#include <iostream>
#include <numbers>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/mesh/mesh_report.h"
#include "formats/mesh_file.h"
#include "formats/part_facts.h"
#include "formats/read_file.h"
#include "formats/scratch_folder.h"

namespace fretwork {
namespace {

constexpr double kPi = std::numbers::pi;

/// A plate of 20 x 30 x 5 mm with a hole of radius 4 mm.
TopoDS_Shape plate() {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(20.0, 30.0, 5.0).Shape();
    const gp_Ax2 axis(gp_Pnt(10, 15, -1), gp_Dir(0, 0, 1));
    return BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(axis, 4.0, 7.0).Shape()).Shape();
}

std::string brep_of(const TopoDS_Shape& shape) {
    std::ostringstream out;
    BRepTools::Write(shape, out);
    return out.str();
}

std::string step_of(const TopoDS_Shape& shape) {
    const ScratchFolder folder;
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    REQUIRE(writer.Write((folder / "model.step").c_str()) == IFSelect_RetDone);
    return read_file(folder / "model.step");
}

std::string iges_of(const TopoDS_Shape& shape) {
    const ScratchFolder folder;
    IGESControl_Writer writer;  // faces, each with edges of its own
    REQUIRE(writer.AddShape(shape));
    REQUIRE(writer.Write((folder / "model.igs").c_str()));
    return read_file(folder / "model.igs");
}

/// The faces of a shape without what holds them together, each inside out.
TopoDS_Shape loose_faces_of(const TopoDS_Shape& shape) {
    TopoDS_Compound loose;
    const BRep_Builder builder;
    builder.MakeCompound(loose);
    for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
        builder.Add(loose, BRepBuilderAPI_Copy(face.Current()).Shape().Reversed());
    return loose;
}

TEST_CASE("cad: a solid comes out closed, outward and of its volume", "[formats][cad]") {
    const double expected = 20 * 30 * 5 - kPi * 16 * 5;
    const MeshFile brep = read_cad(brep_of(plate()), CadFormat::kBrep, "plate.brep");
    const MeshFile step = read_cad(step_of(plate()), CadFormat::kStep, "plate.step");
    const MeshFile iges = read_cad(iges_of(plate()), CadFormat::kIges, "plate.igs");
    // Faces that only lie beside each other are one body all the same.
    const MeshFile loose = read_cad(brep_of(loose_faces_of(plate())), CadFormat::kBrep, "loose.brep");
    for (const MeshFile* file : {&brep, &step, &iges, &loose}) {
        const MeshReport report = report_mesh(file->mesh);
        CHECK(report.closed_manifold());
        CHECK(report.components == 1);
        // The polygon in place of the hole's circle turns by at most 0.2 rad per side: its area is smaller by at
        // most the share 0.2^2 / 6, so the plate is larger by at most that of the hole.
        CHECK(report.volume_mm3 >= expected);
        CHECK(report.volume_mm3 <= expected + kPi * 16 * 5 * 0.04 / 6);
        CHECK(report.max_mm == Vec3(20, 30, 5));
        REQUIRE(file->parts.size() == 1);
        CHECK(file->parts[0].name == "solid 1");
    }
}

TEST_CASE("cad: loose faces that meet nothing stay as they are", "[formats][cad]") {
    TopoDS_Compound all;
    const BRep_Builder builder;
    builder.MakeCompound(all);
    builder.Add(all, plate());
    const TopoDS_Shape far = BRepPrimAPI_MakeBox(gp_Pnt(50, 0, 0), 8.0, 8.0, 8.0).Shape();
    builder.Add(all, TopExp_Explorer(loose_faces_of(far), TopAbs_FACE).Current());
    const MeshFile file = read_cad(brep_of(all), CadFormat::kBrep, "both.brep");
    REQUIRE(file.parts.size() == 2);
    CHECK(file.parts[1].name == "loose faces");
    CHECK(file.parts[1].triangle_count == 2);
    CHECK(report_mesh(file.mesh).border_edges == 4);
    CHECK(file.faces.back().name == "Face8");
}

TEST_CASE("cad: a finer deviation comes closer to a sphere", "[formats][cad]") {
    const std::string bytes = brep_of(BRepPrimAPI_MakeSphere(10.0).Shape());
    const double expected = 4.0 / 3.0 * kPi * 1000;
    double last_error = expected;
    for (const double angle : {0.5, 0.2, 0.08}) {
        const MeshFile file = read_cad(bytes, CadFormat::kBrep, "ball", {1e-2 * angle, angle});
        const MeshReport report = report_mesh(file.mesh);
        CHECK(report.closed_manifold());
        const double error = expected - report.volume_mm3;
        CHECK(error > 0.0);
        CHECK(error < 0.5 * last_error);
        last_error = error;
    }
}

TEST_CASE("cad: a face is told by its area, centre and normal", "[formats][cad][info]") {
    const MeshFile file = read_cad(brep_of(plate()), CadFormat::kBrep, "plate.brep");
    const auto value = [](const Facts& facts, std::string_view name) -> std::optional<FactValue> {
        for (const auto& [key, held] : facts.entries)
            if (key == name) return held;
        return {};
    };
    int holes = 0, tops = 0;
    for (const MeshPart& face : file.faces) {
        const Facts facts = face_facts(file.mesh, face);
        CHECK(std::get<std::string>(*value(facts, "name")) == face.name);
        const auto center = std::get<std::vector<double>>(*value(facts, "center_mm"));
        const double area = std::get<double>(*value(facts, "area_mm2"));
        const auto normal = value(facts, "mean_normal");
        if (!normal) {  // the hole
            ++holes;
            CHECK(area == Approx(2 * kPi * 4 * 5).epsilon(0.01));
            CHECK_THAT(center, Catch::Approx(std::vector<double>{10, 15, 2.5}).margin(1e-9));
        } else if (std::get<std::vector<double>>(*normal)[2] > 0.5) {
            ++tops;
            CHECK(area == Approx(600 - kPi * 16).epsilon(0.01));
            CHECK_THAT(center, Catch::Approx(std::vector<double>{10, 15, 5}).margin(1e-9));
        }
    }
    CHECK(holes == 1);
    CHECK(tops == 1);
}

TEST_CASE("cad: faces keep the numbers of the shape's own order", "[formats][cad]") {
    const TopoDS_Shape shape = plate();
    const auto [what, file] = GENERATE_COPY(
        std::pair("solid", read_cad(brep_of(shape), CadFormat::kBrep, "plate.brep")),
        std::pair("loose faces", read_cad(brep_of(loose_faces_of(shape)), CadFormat::kBrep, "loose.brep")),
        std::pair("IGES", read_cad(iges_of(shape), CadFormat::kIges, "plate.igs")));
    CAPTURE(what);
    REQUIRE(file.faces.size() == 7);
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    std::uint32_t next = 0;
    for (const MeshPart& face : file.faces) {
        CAPTURE(face.name);
        CHECK(face.first_triangle == next);
        next += face.triangle_count;
        // The triangles lie within the box of the face of that number.
        const int number = std::stoi(face.name.substr(4));
        Bnd_Box box;
        BRepBndLib::Add(faces(number), box);
        box.Enlarge(1e-3);
        for (std::uint32_t t = 0; t < face.triangle_count; ++t)
            for (const std::uint32_t v : file.mesh.triangles[face.first_triangle + t]) {
                const Vec3& p = file.mesh.positions_mm[v];
                CHECK_FALSE(box.IsOut(gp_Pnt(p[0], p[1], p[2])));
            }
    }
    CHECK(next == file.mesh.triangles.size());
    // The hole is the one face that is curved: of 16 or more sides.
    CHECK(std::count_if(file.faces.begin(), file.faces.end(),
                        [](const MeshPart& f) { return f.triangle_count >= 32; }) >= 1);
}

TEST_CASE("cad: a deviation in millimetres bounds the distance from the true face", "[formats][cad]") {
    const std::string bytes = brep_of(BRepPrimAPI_MakeSphere(10.0).Shape());
    std::size_t last = 0;
    for (const double deviation : {0.4, 0.1, 0.02}) {
        CadMeshing meshing;
        meshing.angle_rad = 1.0;
        meshing.deviation_mm = deviation;
        const MeshFile file = read_cad(bytes, CadFormat::kBrep, "ball", meshing);
        double deepest = 0.0;
        for (const Triangle& t : file.mesh.triangles) {
            Vec3 center = Vec3::Zero();
            for (const std::uint32_t v : t) center += file.mesh.positions_mm[v] / 3.0;
            deepest = std::max(deepest, 10.0 - center.norm());
        }
        CHECK(deepest <= 1.5 * deviation);
        CHECK(file.mesh.triangles.size() > last);
        last = file.mesh.triangles.size();
    }
}

TEST_CASE("cad: triangles follow the voxels that a carve asks for", "[formats][cad]") {
    const std::string bytes = brep_of(BRepPrimAPI_MakeSphere(10.0).Shape());
    const auto depth_in_voxels = [&](const Settings& settings, double voxel_mm) {
        CadMeshing meshing = meshing_for(settings);
        meshing.angle_rad = 1.5;  // so that the distance decides
        double deepest = 0.0;
        const MeshFile file = read_cad(bytes, CadFormat::kBrep, "ball", meshing);
        for (const Triangle& t : file.mesh.triangles) {
            Vec3 center = Vec3::Zero();
            for (const std::uint32_t v : t) center += file.mesh.positions_mm[v] / 3.0;
            deepest = std::max(deepest, 10.0 - center.norm());
        }
        return deepest / voxel_mm;
    };
    // OpenCASCADE measures along edges; the middle of a triangle lies up to half as far again.
    const auto a_tenth = [](double depth) { return depth > 0.01 && depth < 0.15; };
    Settings settings;
    CHECK(a_tenth(depth_in_voxels(settings, 20.0 / kDefaultResolution)));
    settings.shell.resolution = 64;
    CHECK(a_tenth(depth_in_voxels(settings, 20.0 / 64.0)));
    settings.shell.resolution.reset();
    settings.shell.voxel_mm = 0.5;
    CHECK(a_tenth(depth_in_voxels(settings, 0.5)));
    settings.input.scale = 4.0;  // the file's own voxels are a fourth
    CHECK(a_tenth(depth_in_voxels(settings, 0.125)));
    settings.input.size_mm = 40.0;  // twice the ball of 20 mm
    CHECK(a_tenth(depth_in_voxels(settings, 0.25)));
}

TEST_CASE("cad: the same file gives the same mesh", "[formats][cad][determinism]") {
    const std::string bytes = brep_of(plate());
    const MeshFile first = read_cad(bytes, CadFormat::kBrep, "a"), second = read_cad(bytes, CadFormat::kBrep, "b");
    CHECK(first.mesh.positions_mm == second.mesh.positions_mm);
    CHECK(first.mesh.triangles == second.mesh.triangles);
}

TEST_CASE("cad: what cannot be read is refused", "[formats][cad][errors]") {
    for (const CadFormat format : {CadFormat::kStep, CadFormat::kIges, CadFormat::kBrep})
        for (const std::string bytes : {"", "not a model", "ISO-10303-21;\nHEADER;\n"})
            CHECK_THROWS_AS(read_cad(bytes, format, "x"), InvalidInput);
    CHECK_THROWS_AS(read_cad("", CadFormat::kStep, "x", {0.0, 0.2}), InvalidSetting);
    const std::string step = step_of(plate()), brep = brep_of(plate());
    // Nothing of it is said on standard output, where data belongs.
    std::ostringstream said;
    std::streambuf* const before = std::cout.rdbuf(said.rdbuf());
    for (std::size_t size = 100; size < brep.size(); size += 401)
        CHECK_THROWS_AS(read_cad(brep.substr(0, size), CadFormat::kBrep, "cut.brep"), InvalidInput);
    std::string without_surfaces = brep;
    without_surfaces.replace(brep.find("Surfaces "), 9, "Surfacez ");
    CHECK_THROWS_AS(read_cad(without_surfaces, CadFormat::kBrep, "spoilt.brep"), InvalidInput);
    const std::string iges = iges_of(plate());
    for (std::size_t size = 100; size < iges.size() - 81; size += 1301)
        CHECK_THROWS_AS(read_cad(iges.substr(0, size), CadFormat::kIges, "cut.igs"), InvalidInput);
    CHECK_NOTHROW(read_cad(iges + "\r\n\n", CadFormat::kIges, "ends.igs"));
    std::cout.rdbuf(before);
    CHECK(said.str().empty());
    CHECK(std::cout.good());
    for (std::size_t size = 0; size < step.size(); size += 997) {
        CAPTURE(size);
        CHECK_THROWS_AS(read_cad(step.substr(0, size), CadFormat::kStep, "cut.step"), InvalidInput);
    }
}

TEST_CASE("cad: chosen by extension, read only", "[formats][cad]") {
    CHECK(mesh_format_from_path("a.STP") == MeshFormat::kStep);
    CHECK(read_mesh(brep_of(plate()), MeshFormat::kBrep, "m", {.unit = LengthUnit::kCentimeter})
              .mesh.positions_mm.size() > 8);
    CHECK_THROWS_AS(write_mesh({TriangleMesh{}}, MeshFormat::kStep), InvalidSetting);
}

}  // namespace
}  // namespace fretwork
