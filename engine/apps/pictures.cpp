#include "apps/pictures.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace afterglow {

Result<const PictureFunctions*> load_pictures() {
  // Never unloaded: pictures keep objects of the module alive.
  static void* const module = dlopen("libafterglow_pictures.so", RTLD_LAZY | RTLD_LOCAL);
  static const void* const table = module ? dlsym(module, kPictureFunctionsSymbol) : nullptr;
  if (table == nullptr)
    return Error{ErrorKind::other, "the installation is broken: libafterglow_pictures.so cannot be loaded"};
  return static_cast<const PictureFunctions*>(table);
}

}  // namespace afterglow
