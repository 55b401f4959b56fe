#include "gi/settings.h"
