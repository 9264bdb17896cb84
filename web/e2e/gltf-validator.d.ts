// The Khronos validator brings no types of its own.
declare module "gltf-validator" {
  export interface Message {
    code: string;
    message: string;
    severity: number;
    pointer?: string;
  }
  export function validateBytes(
    data: Uint8Array,
  ): Promise<{ issues: { numErrors: number; numWarnings: number; messages: Message[] } }>;
}
