#include "feldspar/fast/choose_kernels.hpp"

#include <atomic>
#include <cstdlib>
#include <string_view>

namespace feldspar {
namespace {

double* pairs(Array<Vec2>& v) { return v.empty() ? nullptr : &v.front().x; }

void point_broke(Assembly& assembly, int contact_number, int j, BondEvent event, long long step) {
    const Contact& contact = assembly.contacts[contact_number];
    const int p = contact.first_point + j;
    ContactPoint& point = assembly.points[p];
    BondState bond = assembly.bond(p);
    note_break(point, assembly.law_of(contact), event, step, bond);
    assembly.set_bond(p, bond);
}

}  // namespace

KernelArrays::KernelArrays(Assembly& s)
    : assembly(&s),
      grain_packs(s.packs.grains.data()),
      pack_forces(s.packs.forces.data()),
      contact_packs(s.packs.contacts.data()),
      rigid_bodies(s.packs.rigid.data()),
      laws(s.laws.data()),
      own_form(s.own_laws.form),
      own{s.own_laws.constants.Kn_Pa_m.data(),  s.own_laws.constants.Ks_Pa_m.data(),     s.own_laws.constants.x0_normal.data(),
          s.own_laws.constants.x0_shear.data(), s.own_laws.constants.x_fl_normal.data(), s.own_laws.constants.x_fl_shear.data(),
          s.own_laws.constants.mu.data()},
      volumetric(s.packs.volumetric.empty() ? nullptr : s.packs.volumetric.data()),
      deviatoric(s.packs.deviatoric.empty() ? nullptr : s.packs.deviatoric.data()),
      weight(pairs(s.weight)),
      reference(pairs(s.nodes.reference)),
      inverse_mass(pairs(s.nodes.inverse_mass)),
      loading_mode(pairs(s.nodes.loading_mode)),
      mass(s.nodes.mass.data()),
      displacement(pairs(s.nodes.displacement)),
      velocity(pairs(s.nodes.velocity)),
      force(pairs(s.nodes.force)),
      un(s.bonds.un_m.data()),
      us(s.bonds.us_m.data()),
      Fn(s.bonds.Fn_N.data()),
      Fs(s.bonds.Fs_N.data()),
      max_un(s.bonds.max_un_m.data()),
      max_us(s.bonds.max_us_m.data()),
      damage(s.bonds.damage.data()),
      fracture(s.bonds.fracture_J.data()),
      friction(s.bonds.friction_J.data()),
      offset(s.packs.offset.data()),
      tangent_x(s.packs.tangent_x.data()),
      tangent_y(s.packs.tangent_y.data()),
      normal_x(s.packs.normal_x.data()),
      normal_y(s.packs.normal_y.data()),
      along(s.packs.along.data()),
      area(s.packs.area.data()),
      line_a(s.packs.line_a.data()),
      line_b(s.packs.line_b.data()),
      shared(s.packs.shared.data()),
      bare(s.packs.bare.data()),
      more_of_rigid(s.packs.more_of_rigid.data()),
      scale(s.packs.scale.data()),
      lines(s.packs.lines.data()),
      slots(s.slots.data()),
      rigid_forces(s.packs.rigid_forces.data()),
      inverse_cross(s.packs.inverse_cross.data()),
      body_work(s.body_work.data()),
      line_of_first_body(s.packs.line_of_first_body),
      grain_pack_count(static_cast<std::int32_t>(s.packs.grains.size())),
      contact_pack_count(static_cast<std::int32_t>(s.packs.contacts.size())),
      node_count(s.nodes.count()),
      thickness(s.thickness_m),
      D11(s.elasticity.empty() ? 0.0 : s.elasticity.front().D11),
      D12(s.elasticity.empty() ? 0.0 : s.elasticity.front().D12),
      broke(point_broke) {}

const std::array<const Kernels*, 3>& all_kernels() {
#if defined(__x86_64__)
    static const std::array<const Kernels*, 3> kernels{&kernels_avx512, &kernels_avx2, &kernels_portable};
#else
    static const std::array<const Kernels*, 3> kernels{&kernels_portable, &kernels_portable, &kernels_portable};
#endif
    return kernels;
}

bool is_supported([[maybe_unused]] const Kernels& kernels) {
#if defined(__x86_64__)
    const std::string_view name = kernels.name;
    if (name == "avx512")
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if (name == "avx2") return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
    return true;
}

namespace {

const Kernels& wanted_kernels() {
    const char* wanted = std::getenv("FELDSPAR_KERNELS");
    for (const Kernels* kernels : all_kernels())
        if (is_supported(*kernels) && (wanted == nullptr || std::string_view(wanted) == kernels->name)) return *kernels;
    for (const Kernels* kernels : all_kernels())
        if (is_supported(*kernels)) return *kernels;
    return kernels_portable;
}

std::atomic<const Kernels*>& chosen() {
    static std::atomic<const Kernels*> kernels{&wanted_kernels()};
    return kernels;
}

}  // namespace

const Kernels& best_kernels() { return *chosen().load(std::memory_order_relaxed); }

void use_kernels(const Kernels& kernels) { chosen().store(&kernels, std::memory_order_relaxed); }

}  // namespace feldspar
