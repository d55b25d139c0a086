#include "core/render/lighting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/counter_random.h"

namespace fretwork {
namespace {

// Chosen by eye so that a matt surface turned half-way to the light shows its own colour.
const Vec3f kKeyColor(0.74f, 0.715f, 0.67f);
const Vec3f kZenith(0.52f, 0.545f, 0.58f);
const Vec3f kHorizon(0.37f, 0.38f, 0.40f);
const Vec3f kGround(0.24f, 0.23f, 0.22f);
/// What a blocked direction still returns: light that bounced between surfaces.
const Vec3f kBounce(0.13f, 0.12f, 0.11f);
constexpr float kKeySpread = 0.14f;  // tangent of the key light's half angle
constexpr float kGloss = 0.05f, kGlossPower = 60.0f;
/// Rays start this far off the surface, in scene units: well above the rounding of a hit, well below any wall.
constexpr float kLift = 1e-4f;

Vec3f sky(const Vec3f& direction) {
    const float z = direction.z();
    return z >= 0 ? Vec3f(kHorizon + std::sqrt(z) * (kZenith - kHorizon))
                  : Vec3f(kHorizon - std::min(1.0f, -4 * z) * (kHorizon - kGround));
}

/// Two unit vectors that make a frame with `n`, without a branch that jumps \cite duff2017frame.
void make_frame(const Vec3f& n, Vec3f& a, Vec3f& b) {
    const float sign = std::copysign(1.0f, n.z());
    const float p = -1.0f / (sign + n.z());
    const float q = n.x() * n.y() * p;
    a = Vec3f(1.0f + sign * n.x() * n.x() * p, sign * q, -sign * n.x());
    b = Vec3f(q, sign + n.y() * n.y() * p, -n.y());
}

Vec2f on_disc(const Vec2f& xi) {
    const float r = std::sqrt(xi.x()), turn = 2 * std::numbers::pi_v<float> * xi.y();
    return {r * std::cos(turn), r * std::sin(turn)};
}

/// Distributed like the cosine to `normal`, so that the mean over samples is the irradiance over pi.
Vec3f around(const Vec3f& normal, const Vec2f& xi) {
    Vec3f a, b;
    make_frame(normal, a, b);
    const Vec2f d = on_disc(xi);
    return d.x() * a + d.y() * b + std::sqrt(std::max(0.0f, 1 - d.squaredNorm())) * normal;
}

}  // namespace

SampleSequence::SampleSequence(std::uint64_t pixel) {
    const std::uint64_t bits = counter_random(0, RandomStream::kRender, 0, pixel, 0);
    shift_x_ = static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
    shift_y_ = static_cast<double>(bits >> 32) * 0x1p-32;
}

Vec2f SampleSequence::at(int sample) const {
    // The additive sequence of the plastic number fills the square evenly for any count of samples.
    const double x = shift_x_ + 0.7548776662466927 * sample, y = shift_y_ + 0.5698402909980532 * sample;
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
}

Lighting::Lighting(const RayScene& scene, const Camera& camera, bool shadows) : scene_(scene), shadows_(shadows) {
    // From the upper left of the viewer's side, whatever the viewer's direction.
    const Vec3 level_to_eye = Vec3::UnitZ().cross(camera.right()) * -1.0;
    key_ = (-0.55 * camera.right() + 0.85 * Vec3::UnitZ() + 0.55 * level_to_eye).normalized().cast<float>();
    make_frame(key_, key_side_, key_other_);
}

bool Lighting::key_is_seen(const Vec3f& point, const Vec2f& xi, Vec3f& towards) const {
    const Vec2f d = kKeySpread * on_disc(xi);
    towards = (key_ + d.x() * key_side_ + d.y() * key_other_).normalized();
    return !shadows_ || !scene_.is_blocked(point, towards);
}

Incoming Lighting::on_model(const Vec3f& point, const Vec3f& facet, const Vec3f& normal, const Vec3f& to_eye,
                            const SampleSequence& random, int sample) const {
    const Vec3f start = point + kLift * facet;
    Incoming in;
    const float cosine = normal.dot(key_);
    Vec3f towards;
    if (cosine > 0 && facet.dot(key_) > 0 && key_is_seen(start, random.at(2 * sample), towards)) {
        in.diffuse = cosine * kKeyColor;
        in.gloss = kGloss * std::pow(std::max(0.0f, normal.dot((towards + to_eye).normalized())), kGlossPower);
    }
    if (!shadows_) {
        in.diffuse += sky(normal);
        return in;
    }
    Vec3f from_sky = around(normal, random.at(2 * sample + 1));
    // A shading normal may send a ray below the facet; its mirror image stands in.
    if (const float below = from_sky.dot(facet); below < 0) from_sky -= 2 * below * facet;
    in.diffuse += scene_.is_blocked(start, from_sky) ? kBounce : sky(from_sky);
    return in;
}

float Lighting::on_floor(const Vec3f& point, const SampleSequence& random, int sample) const {
    if (!shadows_) return 1.0f;
    const Vec3f start = point + kLift * Vec3f::UnitZ();
    constexpr float kKeyShare = 0.42f;  // the rest comes from the sky
    Vec3f towards;
    const bool key = key_is_seen(start, random.at(2 * sample), towards);
    const bool open = !scene_.is_blocked(start, around(Vec3f::UnitZ(), random.at(2 * sample + 1)));
    constexpr float kLeast = 0.10f;  // bounced light
    return kLeast + (1 - kLeast) * ((key ? kKeyShare : 0.0f) + (open ? 1 - kKeyShare : 0.0f));
}

}  // namespace fretwork
