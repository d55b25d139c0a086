#include "formats/cad_reader.h"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESControl_Reader.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <mutex>
#include <sstream>
#include <streambuf>
#include <string>

#include "core/base/error.h"
#include "core/base/float_rounding.h"
#include "formats/atomic_write.h"
#include "formats/cad_sewing.h"
#include "formats/parse_error.h"
#include "formats/scratch_folder.h"
#include "formats/weld_equal.h"

namespace fretwork {
namespace {

/// OpenCASCADE's readers and its messenger are global.
std::mutex& cad_mutex() {
    static std::mutex mutex;
    return mutex;
}

/// What OpenCASCADE says on std::cout of a broken file goes nowhere: standard output is for data.
class SilentCout {
  public:
    SilentCout() : before_(std::cout.rdbuf(nullptr)) {}
    ~SilentCout() { std::cout.rdbuf(before_); }
    SilentCout(const SilentCout&) = delete;
    SilentCout& operator=(const SilentCout&) = delete;

  private:
    std::streambuf* before_;
};

template <class Reader>
TopoDS_Shape transferred(Reader& reader) {
    reader.TransferRoots();
    return reader.OneShape();
}

/// The last line of an IGES file has a T in column 73.
bool is_terminated_iges(std::string_view bytes) {
    const std::size_t end = bytes.find_last_not_of(" \r\n") + 1;
    const std::size_t line = bytes.substr(0, end).find_last_of("\r\n") + 1;
    return end - line > 72 && bytes[line + 72] == 'T';
}

/// A null shape when the file cannot be read.
TopoDS_Shape read_shape(std::string_view bytes, CadFormat format) {
    std::istringstream stream{std::string(bytes)};
    if (format == CadFormat::kBrep) {
        TopoDS_Shape shape;
        if (bytes.substr(0, 4096).find("CASCADE Topology V") == bytes.npos) return shape;
        const BRep_Builder builder;
        // At the end of a file that is cut off OpenCASCADE would read on for ever.
        stream.exceptions(std::ios::failbit | std::ios::badbit);
        try {
            BRepTools::Read(shape, stream, builder);
        } catch (const std::ios::failure&) {
            shape.Nullify();
        }
        return shape;
    }
    if (format == CadFormat::kStep) {
        STEPControl_Reader reader;
        return reader.ReadStream("memory", stream) == IFSelect_RetDone ? transferred(reader) : TopoDS_Shape();
    }
    // OpenCASCADE takes what there is of a file that is cut off.
    if (!is_terminated_iges(bytes)) return {};
    // It reads IGES from files alone.
    const ScratchFolder folder;
    const std::string path = folder / "model.igs";
    atomic_write(path, bytes);
    IGESControl_Reader reader;
    return reader.ReadFile(path.c_str()) == IFSelect_RetDone ? transferred(reader) : TopoDS_Shape();
}

double longest_side(const TopoDS_Shape& shape) {
    Bnd_Box box;
    BRepBndLib::Add(shape, box, Standard_False);
    if (box.IsVoid()) return 1.0;
    double low[3], high[3];
    box.Get(low[0], low[1], low[2], high[0], high[1], high[2]);
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

void break_into_triangles(const TopoDS_Shape& shape, const CadMeshing& meshing) {
    IMeshTools_Parameters parameters;
    parameters.Deflection =
        meshing.deviation_mm ? *meshing.deviation_mm : meshing.deviation_share * longest_side(shape);
    parameters.Angle = meshing.angle_rad;
    parameters.InParallel = Standard_False;
    BRepMesh_IncrementalMesh(shape, parameters);
}

constexpr double kNothing = 1e-12;  // of the longest side

class FaceCollector {
  public:
    FaceCollector(const SewnShape& sewn, std::string_view source)
        : source_(source), welder_(1 << 16), nothing_(kNothing * longest_side(sewn.shape)) {
        for (const TopoDS_Shape& face : sewn.faces) numbers_.Add(face);
    }

    void add_faces(const TopoDS_Shape& within, TopAbs_ShapeEnum but_not_in = TopAbs_SHAPE) {
        for (TopExp_Explorer face(within, TopAbs_FACE, but_not_in); face.More(); face.Next())
            add_face(TopoDS::Face(face.Current()));
    }

    void close_part(const std::string& name) {
        const auto now = static_cast<std::uint32_t>(file_.mesh.triangles.size());
        const std::uint32_t first =
            file_.parts.empty() ? 0 : file_.parts.back().first_triangle + file_.parts.back().triangle_count;
        if (now > first) file_.parts.push_back({name, first, now - first});
    }

    MeshFile take() {
        file_.mesh.positions_mm = welder_.take_positions();
        return std::move(file_);
    }

  private:
    void add_face(const TopoDS_Face& face) {
        TopLoc_Location location;
        const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
        const Standard_Integer number = numbers_.FindIndex(face);
        const auto first = static_cast<std::uint32_t>(file_.mesh.triangles.size());
        faces_ = static_cast<std::size_t>(number);
        if (triangulation.IsNull())
            fail_parse(source_, "face " + std::to_string(faces_), "a surface that cannot be broken into triangles",
                       "a sound face");
        const gp_Trsf& transform = location.Transformation();
        const bool turned = (face.Orientation() == TopAbs_REVERSED) != transform.IsNegative();
        for (Standard_Integer t = 1; t <= triangulation->NbTriangles(); ++t) {
            Standard_Integer node[3];
            triangulation->Triangle(t).Get(node[0], node[1], node[2]);
            if (turned) std::swap(node[1], node[2]);
            Triangle triangle{};
            for (std::size_t k = 0; k < 3; ++k) {
                const gp_Pnt p = triangulation->Node(node[k]).Transformed(transform);
                triangle[k] = welder_.index_of(placed(p));
            }
            if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
                file_.mesh.triangles.push_back(triangle);
        }
        file_.faces.push_back(
            {"Face" + std::to_string(number), first, static_cast<std::uint32_t>(file_.mesh.triangles.size()) - first});
    }

    /// Two faces may differ in the last bits of the points on their common edge; rounded to floats they agree, but for
    /// what is meant to be 0.
    Vec3 placed(const gp_Pnt& p) const {
        Vec3 rounded = rounded_to_float(Vec3(p.X(), p.Y(), p.Z()));
        for (double& x : rounded)
            if (std::abs(x) < nothing_) x = 0.0;
        if (!(rounded.cwiseAbs().maxCoeff() <= kMaxCoordinate))
            fail_parse(source_, "face " + std::to_string(faces_), "a coordinate that is not finite or over 1e9",
                       "a smaller one");
        return rounded;
    }

    std::string_view source_;
    EqualPointWelder welder_;
    MeshFile file_;
    TopTools_IndexedMapOfShape numbers_;
    double nothing_;         ///< smaller coordinates are 0
    std::size_t faces_ = 0;  ///< number of the one in hand
};

MeshFile collect(const SewnShape& sewn, std::string_view source, const RunControl& run) {
    const TopoDS_Shape& shape = sewn.shape;
    FaceCollector collector(sewn, source);
    int solids = 0;
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
        run.throw_if_stopped();
        collector.add_faces(solid.Current());
        collector.close_part("solid " + std::to_string(++solids));
    }
    collector.add_faces(shape, TopAbs_SOLID);
    collector.close_part("loose faces");
    return collector.take();
}

}  // namespace

MeshFile read_cad(std::string_view bytes, CadFormat format, std::string_view source, const CadMeshing& meshing,
                  const RunControl& run) {
    const double deviation = meshing.deviation_mm.value_or(meshing.deviation_share);
    if (!(deviation > 0.0) || !(meshing.angle_rad > 0.0))
        throw InvalidSetting("CAD meshing: found deviation " + std::to_string(deviation) + " and angle " +
                             std::to_string(meshing.angle_rad) + ", expected both above 0");
    const std::lock_guard lock(cad_mutex());
    const SilentCout silent;
    // What OpenCASCADE has to say would go to standard output, where data belongs.
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
    try {
        const TopoDS_Shape shape = read_shape(bytes, format);
        if (shape.IsNull())
            fail_parse(source, place_of_byte(0), in_quotes(bytes.substr(0, 40)), "a readable CAD model");
        run.throw_if_stopped();
        const SewnShape sewn = sew_loose_faces(shape, longest_side(shape));
        run.throw_if_stopped();
        break_into_triangles(sewn.shape, meshing);
        run.throw_if_stopped();
        MeshFile file = collect(sewn, source, run);
        if (file.mesh.triangles.empty()) fail_parse(source, place_of_byte(0), "no face", "at least one");
        return file;
    } catch (const Standard_Failure& failure) {
        fail_parse(source, place_of_byte(0), in_quotes(failure.GetMessageString()), "a readable CAD model");
    }
}

}  // namespace fretwork
