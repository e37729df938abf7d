// Stands where 3d-tiles-renderer imports three's GLTFLoader, which nothing calls here: tiles are read by glb.ts.
export class GLTFLoader {}
