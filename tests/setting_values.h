// Values of settings for tests of all of them.
#pragma once

#include "gi/settings.h"

namespace irad::test {

/// An allowed value other than the one it has, as a number.
inline double anotherValue(const Setting& setting, const Settings& settings) {
  const double now = setting.get(settings);
  if (setting.kind == SettingKind::toggle || setting.kind == SettingKind::choice) return now == 0 ? 1 : 0;
  return now == setting.range.min ? setting.range.max : setting.range.min;
}

}  // namespace irad::test
