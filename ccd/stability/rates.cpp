#include "stability/rates.h"

#include <fmt/format.h>

namespace tightrope::ccd::stability {

std::string_view name(Figure figure) {
  switch (figure) {
    case Figure::misses:
      return "misses";
    case Figure::false_alarms:
      return "false alarms";
    case Figure::uncertain:
      return "uncertain signs";
    case Figure::exact:
      return "exact arithmetic";
  }
  return {};
}

Rate rate(Figure figure, const Map& map, const MethodCounts& method, std::size_t cell) {
  switch (figure) {
    case Figure::misses:
      return {method.misses[cell], map.contacts[cell]};
    case Figure::false_alarms:
      return {method.false_alarms[cell], map.queries[cell] - map.contacts[cell]};
    case Figure::uncertain:
      return {method.uncertain_signs[cell], method.signs[cell]};
    case Figure::exact:
      return method.exact.empty() ? Rate{} : Rate{method.exact[cell], map.queries[cell]};
  }
  return {};
}

Rate rate(Figure figure, const Map& map, const MethodCounts& method) {
  Rate sum;
  for (std::size_t cell = 0; cell < map.queries.size(); ++cell) sum += rate(figure, map, method, cell);
  return sum;
}

std::string percent(const Rate& rate) {
  if (!rate.known()) return "-";
  if (rate.count == 0) return "0";
  const double value = 100 * rate.value();
  return value < 0.01 ? "< 0.01 %" : fmt::format("{:.{}f} %", value, value < 0.1 ? 2 : value < 10 ? 1 : 0);
}

}  // namespace tightrope::ccd::stability
