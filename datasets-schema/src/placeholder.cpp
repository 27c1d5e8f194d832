// Replaced by the implementation of the schema.
