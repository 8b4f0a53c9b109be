"""Recognition on what the sensor sends: the optics as a first layer, binary gradients, classifiers, their figures."""
