#include "formats/cad_sewing.h"

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>

namespace fretwork {
namespace {

constexpr double kMeetWithin = 1e-5;  // of the longest side
constexpr double kLeastTolerance = 1e-7;

TopoDS_Shape solid_of(const TopoDS_Shell& shell) {
    BRepBuilderAPI_MakeSolid maker(shell);
    TopoDS_Solid solid = maker.Solid();
    BRepLib::OrientClosedSolid(solid);
    return solid;
}

/// The shells of what was sewn, closed ones as solids, and faces that met none.
void add_sewn(const TopoDS_Shape& sewn, TopoDS_Compound& all) {
    const BRep_Builder builder;
    for (TopExp_Explorer shell(sewn, TopAbs_SHELL); shell.More(); shell.Next())
        builder.Add(all,
                    BRep_Tool::IsClosed(shell.Current()) ? solid_of(TopoDS::Shell(shell.Current())) : shell.Current());
    for (TopExp_Explorer face(sewn, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
        builder.Add(all, face.Current());
}

}  // namespace

SewnShape sew_loose_faces(const TopoDS_Shape& shape, double longest_side) {
    SewnShape result{shape, {}};
    TopTools_IndexedMapOfShape numbers;
    TopExp::MapShapes(shape, TopAbs_FACE, numbers);
    BRepBuilderAPI_Sewing sewing(std::max(kMeetWithin * longest_side, kLeastTolerance));
    bool loose = false;
    for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SOLID); face.More(); face.Next(), loose = true)
        sewing.Add(face.Current());
    if (loose) sewing.Perform();
    for (Standard_Integer i = 1; i <= numbers.Extent(); ++i)
        result.faces.push_back(loose && sewing.IsModified(numbers(i)) ? sewing.Modified(numbers(i)) : numbers(i));
    if (!loose) return result;
    TopoDS_Compound all;
    const BRep_Builder builder;
    builder.MakeCompound(all);
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) builder.Add(all, solid.Current());
    add_sewn(sewing.SewedShape(), all);
    result.shape = all;
    return result;
}

}  // namespace fretwork
