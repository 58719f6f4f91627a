// What users read of the table of a rock's properties.
#include "feldspar/output/user_units.hpp"

#include <fmt/format.h>

#include "feldspar/base/angle.hpp"
#include "feldspar/lab/rock_properties.hpp"

namespace feldspar {

UserQuantity user_quantity(const std::string& property) {
    UserQuantity quantity;
    quantity.name = quantity.label = quantity.symbol = property;
    const RockProperty* known = kept_rock_property(property);
    const QuantityUnit unit = known != nullptr             ? known->unit
                              : property.ends_with("_Pa")  ? units::stress
                              : property.ends_with("_deg") ? units::angle
                                                           : units::pure;
    quantity.factor = unit.factor;
    quantity.unit = unit.user;
    if (!unit.kept.empty()) quantity.name = unit.user_name(property.substr(0, property.size() - unit.kept.size() - 1));
    if (known == nullptr) return quantity;
    quantity.label = known->label;
    quantity.symbol = known->symbol;
    quantity.rank = static_cast<double>(known - rock_properties().data());
    if (const auto pressure_MPa = pressure_of_confined_strength_MPa(property)) {
        quantity.label += fmt::format(" = {:.6g} MPa", *pressure_MPa);
        quantity.rank += *pressure_MPa / (1.0 + *pressure_MPa);  // growing pressure, below the next rank
    }
    return quantity;
}

std::string property_of_laboratory(const std::string& name) {
    const RockProperty* property = rock_property(name);
    return property != nullptr ? property->kept_name() : name;
}

double laboratory_as_kept(const std::string& name, double value) {
    const RockProperty* property = rock_property(name);
    return property != nullptr && property->unit == units::angle ? in_degrees(value) : value;
}

double laboratory_in_user_units(const std::string& name, double value) {
    const RockProperty* property = rock_property(name);
    return laboratory_as_kept(name, value) * (property != nullptr ? property->unit.factor : 1.0);
}

}  // namespace feldspar
