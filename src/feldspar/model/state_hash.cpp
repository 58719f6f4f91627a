#include "feldspar/model/state_hash.hpp"

#include <type_traits>

#include "feldspar/base/running_hash.hpp"

namespace feldspar {
namespace {

// Of values as they come.
class Hasher {
public:
    template <class T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T>, "a structure may have bytes between its members");
        hash_.add(&value, sizeof value);
    }
    void add(Vec2 value) {
        add(value.x);
        add(value.y);
    }
    std::uint64_t digest() const { return hash_.digest(); }

private:
    RunningHash hash_;
};

}  // namespace

StateHash hash_state(const Assembly& assembly) {
    Hasher motion, bonds, breaks, work;
    for (const Body& body : assembly.bodies)
        for (const int n : body.nodes()) {
            motion.add(assembly.nodes.displacement[n]);
            motion.add(assembly.nodes.velocity[n]);
        }
    if (assembly.elasticity.size() > 1)
        for (const auto& [D11, D12] : assembly.elasticity) {
            motion.add(D11);
            motion.add(D12);
        }
    for (const Contact& contact : assembly.contacts) {
        if (contact.own_law >= 0) {  // what was drawn
            const LawConstants<double> law = assembly.own_laws.at(contact.own_law);
            for (const double value :
                 {law.Kn_Pa_m, law.Ks_Pa_m, law.x0_normal, law.x0_shear, law.x_fl_normal, law.x_fl_shear, law.mu})
                bonds.add(value);
        }
        breaks.add(contact.a.body);
        breaks.add(contact.b.body);
        breaks.add(contact.dropped);
        breaks.add(contact.initial_shape);
    }
    for (int p = 0; p < static_cast<int>(assembly.points.size()); ++p) {
        const ContactPoint& point = assembly.points[p];
        const BondState bond = assembly.bond(p);
        for (const double value : {bond.un_m, bond.us_m, bond.Fn_N, bond.Fs_N, bond.max_un_m, bond.max_us_m, bond.damage})
            bonds.add(value);
        for (const double value : {bond.fracture_J, bond.friction_J}) work.add(value);
        breaks.add(point.broken_step);
        breaks.add(point.broke_in_tension);
        breaks.add(point.lost_compression);
    }
    for (const BodyWork& of_body : assembly.body_work) {
        work.add(of_body.damping);
        work.add(of_body.pressure);
    }
    return {motion.digest(), bonds.digest(), breaks.digest(), work.digest()};
}

}  // namespace feldspar
