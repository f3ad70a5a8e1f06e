#include "shader_files.h"
