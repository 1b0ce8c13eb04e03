// Generated in a LIGGGHTS build and not installed by Debian. Names the normal models that we instantiate.
#include "normal_model_hertz.h"
#include "normal_model_hooke.h"
