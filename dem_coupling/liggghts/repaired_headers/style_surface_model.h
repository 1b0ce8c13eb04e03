// Generated in a LIGGGHTS build and not installed by Debian. Names the surface models that we instantiate.
#include "surface_model_default.h"
