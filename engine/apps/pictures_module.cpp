// The module that pictures.cpp loads: the image room's functions in one table.
#include "apps/pictures.h"

extern "C" const afterglow::PictureFunctions afterglow_picture_functions;
const afterglow::PictureFunctions afterglow_picture_functions = {
    &afterglow::parse_layer_choice, &afterglow::read_header,  &afterglow::read_picture,
    &afterglow::write_picture,      &afterglow::check_output,
};
