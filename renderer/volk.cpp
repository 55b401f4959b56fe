// The one translation unit that holds the Vulkan entry points (loaded from libvulkan.so.1 at run time).
#define VOLK_IMPLEMENTATION
#include <volk.h>
