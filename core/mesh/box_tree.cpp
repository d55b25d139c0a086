#include "core/mesh/box_tree.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/base/thread_order.h"

namespace fretwork {
namespace {

/// In tree units, where the boxes fill [-1, 1]: sixteen times the rounding of a float of that size.
constexpr double kSlack = 0x1p-20;
/// Queries farther out than this many half extents gain nothing from a tree in float.
constexpr double kFar = 0x1p16;

/// Shared by all trees; Embree counts references and is thread-safe.
RTCDevice shared_device() {
    struct Holder {
        RTCDevice device = rtcNewDevice(nullptr);
        ~Holder() {
            if (device != nullptr) rtcReleaseDevice(device);
        }
    };
    static const Holder holder;
    if (holder.device == nullptr) throw SolverFailure("box tree: Embree found no usable device");
    return holder.device;
}

struct NearWalk {
    double (*visit)(const void*, std::uint32_t);
    const void* self;
    double scale, slack;

    /// Reach in mm -> radius in tree units, never too small.
    [[nodiscard]] float radius(double reach_mm) const {
        if (std::isinf(reach_mm)) return std::numeric_limits<float>::infinity();
        return static_cast<float>(reach_mm * scale * (1.0 + 0x1p-20) + slack);
    }
};

struct SegmentContext {
    RTCIntersectContext base;  // first, so that Embree's pointer is ours
    double (*visit)(const void*, std::uint32_t);
    const void* self;
    double start, share;  // the ray stands for [start, start + share] of the segment
    double slack;         // in the ray's parameter
};

}  // namespace

struct BoxTree::Impl {
    RTCScene scene = nullptr;
    Vec3 center_mm = Vec3::Zero();
    double scale = 1.0;  // tree units per mm
    std::uint32_t count = 0;

    /// What Embree's threads ask for while they build.
    struct Building {
        const Impl& tree;
        std::span<const Box> boxes;
        const RunControl& run;
        ThreadOrder order;
    };

    ~Impl() {
        if (scene != nullptr) rtcReleaseScene(scene);
    }
    [[nodiscard]] Vec3 to_tree(const Vec3& p_mm) const { return (p_mm - center_mm) * scale; }
};

BoxTree::BoxTree(std::span<const Box> boxes, const RunControl& run) : impl_(std::make_unique<Impl>()) {
    Impl& tree = *impl_;
    tree.count = static_cast<std::uint32_t>(boxes.size());
    if (boxes.empty()) return;
    Vec3 low = boxes[0].min_mm, high = boxes[0].max_mm;
    for (const Box& box : boxes) {
        low = low.cwiseMin(box.min_mm);
        high = high.cwiseMax(box.max_mm);
    }
    tree.center_mm = 0.5 * low + 0.5 * high;
    const double half = (0.5 * high - 0.5 * low).maxCoeff();
    tree.scale = half > 0.0 && std::isfinite(1.0 / half) ? 1.0 / half : 1.0;

    const RTCDevice device = shared_device();
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, tree.count);
    Impl::Building building = {tree, boxes, run, {}};
    rtcSetGeometryUserData(geometry, &building);  // asked for only while the scene is committed
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* args) {
            auto& b = *static_cast<Impl::Building*>(args->geometryUserPtr);
            const ThreadOrder::Task running(b.order);
            const Vec3 min = b.tree.to_tree(b.boxes[args->primID].min_mm).array() - kSlack;
            const Vec3 max = b.tree.to_tree(b.boxes[args->primID].max_mm).array() + kSlack;
            RTCBounds& out = *args->bounds_o;
            out.lower_x = static_cast<float>(min[0]), out.upper_x = static_cast<float>(max[0]);
            out.lower_y = static_cast<float>(min[1]), out.upper_y = static_cast<float>(max[1]);
            out.lower_z = static_cast<float>(min[2]), out.upper_z = static_cast<float>(max[2]);
        },
        nullptr);
    rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* args) {
        if (args->valid[0] == 0) return;
        const auto& context = *reinterpret_cast<const SegmentContext*>(args->context);
        const double limit = context.visit(context.self, args->primID);
        const auto tfar = static_cast<float>((limit - context.start) / context.share + context.slack);
        float& far = RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, 1), 1, 0);
        far = std::min(far, tfar);
    });
    rtcCommitGeometry(geometry);
    tree.scene = rtcNewScene(device);
    rtcSetSceneFlags(tree.scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(tree.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneProgressMonitorFunction(
        tree.scene,
        [](void* self, double) {
            auto& b = *static_cast<Impl::Building*>(self);
            const ThreadOrder::Task running(b.order);
            return !b.run.stop_requested();
        },
        &building);
    rtcCommitScene(tree.scene);
    rtcSetSceneProgressMonitorFunction(tree.scene, nullptr, nullptr);
    const RTCError error = rtcGetDeviceError(device);  // asked for in any case: asking clears it
    run.throw_if_stopped();
    if (error != RTC_ERROR_NONE)
        throw SolverFailure("box tree: Embree error " + std::to_string(error) + " for " + std::to_string(tree.count) +
                            " boxes");
}

BoxTree::~BoxTree() = default;
BoxTree::BoxTree(BoxTree&&) noexcept = default;
BoxTree& BoxTree::operator=(BoxTree&&) noexcept = default;

void BoxTree::walk_near(const Vec3& point_mm, double reach_mm, Visitor visit, const void* self) const {
    const Impl& tree = *impl_;
    if (tree.count == 0) return;
    const Vec3 p = tree.to_tree(point_mm);
    const double away = p.cwiseAbs().maxCoeff();
    if (!(away < kFar)) {
        for (std::uint32_t item = 0; item < tree.count; ++item) visit(self, item);
        return;
    }
    NearWalk walk = {visit, self, tree.scale, kSlack * (1.0 + away)};
    RTCPointQuery query{};
    query.x = static_cast<float>(p[0]), query.y = static_cast<float>(p[1]), query.z = static_cast<float>(p[2]);
    query.radius = walk.radius(reach_mm);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(
        tree.scene, &query, &context,
        [](RTCPointQueryFunctionArguments* args) {
            const NearWalk& w = *static_cast<const NearWalk*>(args->userPtr);
            const float narrowed = w.radius(w.visit(w.self, args->primID));
            if (!(narrowed < args->query->radius)) return false;
            args->query->radius = narrowed;
            return true;
        },
        &walk);
}

void BoxTree::walk_along(const Vec3& from_mm, const Vec3& to_mm, Visitor visit, const void* self) const {
    const Impl& tree = *impl_;
    if (tree.count == 0) return;
    const Vec3 a = tree.to_tree(from_mm), b = tree.to_tree(to_mm), d = b - a;
    // Cut to the tree's box first: only there is float as fine as the slack promises.
    double t0 = 0.0, t1 = 1.0;
    constexpr double kEdge = 1.0 + 4 * kSlack;
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0.0) {
            if (std::abs(a[axis]) > kEdge) return;
            continue;
        }
        const double u = (-kEdge - a[axis]) / d[axis], v = (kEdge - a[axis]) / d[axis];
        t0 = std::max(t0, std::min(u, v));
        t1 = std::min(t1, std::max(u, v));
    }
    if (!(t0 <= t1)) return;
    const Vec3 start = a + t0 * d, along = (t1 - t0) * d;
    const double length = along.norm();
    SegmentContext context{};
    rtcInitIntersectContext(&context.base);
    context.visit = visit, context.self = self;
    context.start = t0, context.share = std::max(t1 - t0, std::numeric_limits<double>::min());
    context.slack = 4 * kSlack / std::max(length, kSlack);
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(start[0]), ray.ray.dir_x = static_cast<float>(along[0]);
    ray.ray.org_y = static_cast<float>(start[1]), ray.ray.dir_y = static_cast<float>(along[1]);
    ray.ray.org_z = static_cast<float>(start[2]), ray.ray.dir_z = static_cast<float>(along[2]);
    ray.ray.tnear = 0.0f, ray.ray.tfar = 1.0f;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree.scene, &context.base, &ray);
}

}  // namespace fretwork
