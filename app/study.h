// What `irad study` is asked: the options of all studies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/arguments.h"
#include "app/reference.h"

namespace irad::app {

struct StudyArguments {
  std::vector<std::string> names;  ///< the study, then the scene, or folders
  std::vector<std::string> sweeps, peers;
  std::optional<std::string> out, seeds, repeats, shard, view, referenceSamples, secondReference, peerSamples;
  std::optional<std::string> budgetMs, budgetMib, targetError, cost;  ///< of pick
  ReferenceArgument reference;
  SceneArguments sceneOptions;
  SettingArguments settings;
  DeviceArguments device;
  PictureArguments picture;
};

}  // namespace irad::app
